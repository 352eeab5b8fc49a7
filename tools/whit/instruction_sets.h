// What this program was compiled for, and what the processor it runs on has.
#pragma once

#include <cstdint>
#include <string>

namespace whit {

/// The instruction sets that compilers use on their own, from the oldest to the newest: bits of a mask.
enum class InstructionSet : std::uint8_t {
  Sse3,
  Ssse3,
  Sse41,
  Sse42,
  Popcnt,
  Avx,
  F16c,
  Fma,
  Avx2,
  Bmi1,
  Bmi2,
  Lzcnt,
  Movbe,
  Avx512f,
  Avx512cd,
  Avx512bw,
  Avx512dq,
  Avx512vl,
  Avx512ifma,
  Avx512vbmi,
  Avx512vbmi2,
  Avx512vnni,
  Avx512bitalg,
  Avx512vpopcntdq,
};
static constexpr unsigned kInstructionSets = 24;

/// Its bit in a mask. Static, and not inline: processor_check.cpp must not call a copy of another file's.
static constexpr std::uint32_t bit(InstructionSet set) { return 1U << static_cast<unsigned>(set); }

/// Those that the compiler was allowed to use in all of this program, as a mask. A constant in memory, so that it can be
/// read before any constructor has run.
extern const std::uint32_t kCompiledFor;

/// WHIT_ARCH of the build: "native", or the name of a level, "x86-64-v3". A constant in memory too.
extern const char* const kArchitecture;

/// Those that the processor has and the system lets programs use, as a mask.
std::uint32_t processor_has();

/// What people call one: "AVX2".
const char* name_of(InstructionSet set);

/// What --version says: "x86-64-v3 (AVX2)"; of a native build "native (AVX2), on a processor with AVX-512".
std::string compiled_for();

}  // namespace whit
