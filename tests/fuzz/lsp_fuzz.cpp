// libFuzzer entry: any bytes are what an editor says to the language server, which must answer and never fail.
#include <fcntl.h>
#include <unistd.h>

#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/json_mutator.h"
#include "tools/whit/lsp_server.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  static whit::fuzz::MemoryFile input;
  input.set(data, size);
  whit::fuzz::require(lseek(input.descriptor(), 0, SEEK_SET) == 0);
  whit::lsp::MessageReader reader(input.descriptor());
  whit::lsp::MessageWriter writer(nowhere);
  whit::lsp::Server server(writer);
  while (!server.ended()) {
    const auto incoming = reader.read();
    if (!incoming) break;
    if (incoming->problem) writer.fail(nullptr, *incoming->problem);
    else server.handle(incoming->message, false);
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  return whit::fuzz::mutate_messages(data, size, max_size, seed);
}
