// libFuzzer entry: any bytes are formatted. What formats without a mistake must format the same again, and mean what it
// meant before.
#include <sstream>

#include "parser/format.h"
#include "parser/parse.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/meaning.h"
#include "tests/fuzz/shared/scene_entries.h"

namespace {

using whit::fuzz::require;

/// As in statements_fuzz.cpp.
const std::string kNowhere = "/dev/null/nowhere";

struct Formatted {
  std::string text;
  bool broken = false;
};

Formatted formatted(const std::string& text) {
  whit::Sources sources;
  std::ostringstream out;
  const bool broken = whit::format_text(sources, "fuzz", text, kNowhere, out).has_errors();
  return {out.str(), broken};
}

/// What a text's worlds mean, and how many errors it has.
std::string meaning(const std::string& text) {
  whit::Sources sources;
  const whit::ParseResult result = whit::parse_text(sources, "fuzz", text, kNowhere);
  std::string out;
  for (const whit::SceneDescription& scene : result.scenes) out += whit::fuzz::meaning_of(scene) + '\n';
  for (const whit::Diagnostic& d : result.diagnostics.all())
    out += d.severity == whit::Severity::Error ? d.message : "";
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text = whit::fuzz::text_of(data, size);
  const Formatted once = formatted(text);
  if (once.broken || once.text.empty()) return 0;
  require(formatted(once.text).text == once.text);
  require(meaning(once.text) == meaning(text));
  return 0;
}
