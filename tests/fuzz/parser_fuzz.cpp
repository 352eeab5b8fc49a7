// libFuzzer entry: any bytes are parsed and formatted; nothing may crash, and what formats must format the same again.
#include <cstdlib>
#include <sstream>

#include "parser/format.h"
#include "parser/parse.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Includes resolve below a file, so that none can be opened, but for absolute paths to regular files.
  const std::string nowhere = "/dev/null/nowhere";
  whit::Sources sources;
  const whit::ParseResult result = whit::parse_text(sources, "fuzz", text, nowhere);
  for (const whit::Diagnostic& d : result.diagnostics.all()) sources.render_diagnostic(d, true);
  std::ostringstream once, twice;
  const bool broken = whit::format_text(sources, "fuzz", text, nowhere, once).has_errors();
  if (broken || once.str().empty()) return 0;
  whit::format_text(sources, "once", once.str(), nowhere, twice);
  if (once.str() != twice.str()) std::abort();
  return 0;
}
