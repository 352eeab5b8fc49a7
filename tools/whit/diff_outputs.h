// What `whit diff` writes beside its answer.
#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "tools/whit/diff_flags.h"
#include "tools/whit/diff_table.h"

namespace whit {

/// "", or why the files that are asked for must not be written: two are the same, or one is a file that is read
/// (`pictures`, or the policy) and would be lost.
std::string outputs_conflict(const DiffFlags& flags, const std::vector<std::string>& pictures);

/// Where the answer in words goes: to standard output, or past it where a report is written there.
std::FILE* answer_stream(const DiffFlags& flags);

/// Whether a terminal is there that shows colours.
bool takes_colour(std::FILE* out);

/// "", or which of them cannot be created.
std::string outputs_problem(const DiffFlags& flags);

/// Writes a text to a file, none when `path` is empty; false when it cannot be written, which has been said.
bool write_output(const std::string& path, const std::function<std::string()>& text);

/// The comparisons as JUnit's XML, a test case for each.
std::string junit_of(const DiffFlags& flags, const std::vector<DiffRow>& rows);

}  // namespace whit
