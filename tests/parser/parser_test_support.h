// Helpers of the parser's tests: parse text, find diagnostics, compare scenes without their places.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "parser/parse.h"
#include "parser/scene_description.h"
#include "parser/source.h"

namespace whit {

/// Text parsed, with the sources its positions refer to.
struct Parsed {
  explicit Parsed(const std::string& text, const std::string& folder = "/nowhere", const ParseOptions& options = {})
      : result(parse_text(sources, "test.pbrt", text, folder, options)) {}

  /// The only scene of the text.
  const SceneDescription& scene() const { return result.scenes.at(0); }
  const std::vector<Diagnostic>& all() const { return result.diagnostics.all(); }
  /// Every diagnostic as the user sees it.
  std::string messages() const {
    std::string out;
    for (const Diagnostic& d : all()) out += sources.render_diagnostic(d, false);
    return out;
  }

  Sources sources;
  ParseResult result;
};

/// `body` as the world of a scene; its first line is line 2.
inline std::string in_world(const std::string& body) { return "WorldBegin\n" + body + "\nWorldEnd\n"; }

/// Expects exactly one diagnostic: at line:column, with a message that holds `message`, a remedy that holds `remedy`.
inline void expect_only(const Parsed& parsed, Severity severity, uint64_t line, uint64_t column,
                        const std::string& message, const std::string& remedy = "") {
  ASSERT_EQ(parsed.all().size(), 1u) << parsed.messages();
  const Diagnostic& d = parsed.all()[0];
  EXPECT_EQ(d.severity, severity) << parsed.messages();
  const SourcePlace place = parsed.sources.place(d.where);
  EXPECT_EQ(place.line, line) << parsed.messages();
  EXPECT_EQ(place.column, column) << parsed.messages();
  EXPECT_NE(d.message.find(message), std::string::npos) << parsed.messages();
  EXPECT_NE(d.remedy.find(remedy), std::string::npos) << parsed.messages();
}

inline void expect_clean(const Parsed& parsed) { EXPECT_TRUE(parsed.all().empty()) << parsed.messages(); }

/// A scene as text without any source position, so that equal text means an equal scene.
std::string dump(const SceneDescription& scene);

}  // namespace whit
