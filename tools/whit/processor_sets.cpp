// What the processor has. Compiled for every x86-64 processor, as processor_check.cpp is, which says what that asks of a file.
#include <sys/platform/x86.h>

#include "tools/whit/instruction_sets.h"

namespace whit {

namespace {

constexpr struct Row {
  InstructionSet set;
  unsigned index;  // the C library's number of it
  const char* name;
} kRows[] = {
    {InstructionSet::Sse3, x86_cpu_SSE3, "SSE3"},
    {InstructionSet::Ssse3, x86_cpu_SSSE3, "SSSE3"},
    {InstructionSet::Sse41, x86_cpu_SSE4_1, "SSE4.1"},
    {InstructionSet::Sse42, x86_cpu_SSE4_2, "SSE4.2"},
    {InstructionSet::Popcnt, x86_cpu_POPCNT, "POPCNT"},
    {InstructionSet::Avx, x86_cpu_AVX, "AVX"},
    {InstructionSet::F16c, x86_cpu_F16C, "F16C"},
    {InstructionSet::Fma, x86_cpu_FMA, "FMA"},
    {InstructionSet::Avx2, x86_cpu_AVX2, "AVX2"},
    {InstructionSet::Bmi1, x86_cpu_BMI1, "BMI1"},
    {InstructionSet::Bmi2, x86_cpu_BMI2, "BMI2"},
    {InstructionSet::Lzcnt, x86_cpu_LZCNT, "LZCNT"},
    {InstructionSet::Movbe, x86_cpu_MOVBE, "MOVBE"},
    {InstructionSet::Avx512f, x86_cpu_AVX512F, "AVX-512F"},
    {InstructionSet::Avx512cd, x86_cpu_AVX512CD, "AVX-512CD"},
    {InstructionSet::Avx512bw, x86_cpu_AVX512BW, "AVX-512BW"},
    {InstructionSet::Avx512dq, x86_cpu_AVX512DQ, "AVX-512DQ"},
    {InstructionSet::Avx512vl, x86_cpu_AVX512VL, "AVX-512VL"},
    {InstructionSet::Avx512ifma, x86_cpu_AVX512_IFMA, "AVX-512IFMA"},
    {InstructionSet::Avx512vbmi, x86_cpu_AVX512_VBMI, "AVX-512VBMI"},
    {InstructionSet::Avx512vbmi2, x86_cpu_AVX512_VBMI2, "AVX-512VBMI2"},
    {InstructionSet::Avx512vnni, x86_cpu_AVX512_VNNI, "AVX-512VNNI"},
    {InstructionSet::Avx512bitalg, x86_cpu_AVX512_BITALG, "AVX-512BITALG"},
    {InstructionSet::Avx512vpopcntdq, x86_cpu_AVX512_VPOPCNTDQ, "AVX-512VPOPCNTDQ"},
};

static_assert(sizeof kRows / sizeof(Row) == kInstructionSets);

}  // namespace

const char* name_of(InstructionSet set) {
  for (const Row& row : kRows) {
    if (row.set == set) return row.name;
  }
  return "";
}

// As the C library sees it, which knows what the system saves of the registers when it switches tasks, too. Whoever tells
// it to do without one (GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2), as the test does, has told this.
std::uint32_t processor_has() {
  std::uint32_t sets = 0;
  for (const auto& row : kRows) sets |= x86_cpu_active(row.index) ? bit(row.set) : 0;
  return sets;
}

}  // namespace whit
