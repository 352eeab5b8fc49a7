// libFuzzer entry: any bytes are parsed as a scene, and every message about it is put into words.
#include "parser/parse.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/scene_entries.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // Includes resolve below a file, so that none can be opened, but for absolute paths to regular files.
  const std::string nowhere = "/dev/null/nowhere";
  whit::Sources sources;
  const whit::ParseResult result = whit::parse_text(sources, "fuzz", whit::fuzz::text_of(data, size), nowhere);
  for (const whit::Diagnostic& d : result.diagnostics.all()) sources.render_diagnostic(d, size % 2 == 0);
  whit::fuzz::require(result.diagnostics.has_errors() || !result.scenes.empty());
  return 0;
}
