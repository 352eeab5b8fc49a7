#include "tools/whit/instruction_sets.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace whit {

namespace {

/// The one that people know a processor by.
std::string_view widest(std::uint32_t sets) {
  for (const auto& [set, name] : {std::pair{InstructionSet::Avx512f, "AVX-512"},
                                  {InstructionSet::Avx2, "AVX2"},
                                  {InstructionSet::Avx, "AVX"},
                                  {InstructionSet::Sse42, "SSE4.2"}}) {
    if (sets & bit(set)) return name;
  }
  return "SSE2";
}

}  // namespace

std::string compiled_for() {
  const std::string is = fmt::format("{} ({})", kArchitecture, widest(kCompiledFor));
  if (std::string_view(kArchitecture) != "native") return is;
  return fmt::format("{}, on a processor with {}", is, widest(processor_has()));
}

}  // namespace whit
