// Comparisons as JUnit's XML, which CI systems read.
#pragma once

#include <string>
#include <vector>

namespace whit {

/// One test case. It passed when failure, error and skipped are empty.
struct JUnitCase {
  std::string name;  ///< The picture's, relative to the folder.
  double seconds = 0;
  std::string failure;  ///< What differs, a line; "" when it passed.
  std::string error;    ///< Why it could not be compared; "".
  std::string skipped;  ///< Why it was not compared, which is right so; "".
  std::string details;  ///< Lines: measures, notes.
};

/// A file that the schema of Jenkins' xUnit plugin accepts (junit-10.xsd), and Windy Road's JUnit.xsd, which is Ant's.
/// `suite` is what was compared; `time_stamp` when: "2026-11-29T18:49:00". What XML cannot hold, control characters and
/// bytes that are no UTF-8, is written as \x07.
std::string junit_text(const std::string& suite, const std::vector<JUnitCase>& cases, const std::string& time_stamp);

}  // namespace whit
