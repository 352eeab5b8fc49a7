// What the compiler was allowed to use, as constants alone: they are read before anything else runs, by a program and by a
// Python module that may not run at all here. There is no function in this file, for it would be one of those sets.
#include "tools/whit/instruction_sets.h"

namespace whit {

// One bit where the compiler's own macro is defined.
constinit const std::uint32_t kCompiledFor = 0
#ifdef __SSE3__
                                             | bit(InstructionSet::Sse3)
#endif
#ifdef __SSSE3__
                                             | bit(InstructionSet::Ssse3)
#endif
#ifdef __SSE4_1__
                                             | bit(InstructionSet::Sse41)
#endif
#ifdef __SSE4_2__
                                             | bit(InstructionSet::Sse42)
#endif
#ifdef __POPCNT__
                                             | bit(InstructionSet::Popcnt)
#endif
#ifdef __AVX__
                                             | bit(InstructionSet::Avx)
#endif
#ifdef __F16C__
                                             | bit(InstructionSet::F16c)
#endif
#ifdef __FMA__
                                             | bit(InstructionSet::Fma)
#endif
#ifdef __AVX2__
                                             | bit(InstructionSet::Avx2)
#endif
#ifdef __BMI__
                                             | bit(InstructionSet::Bmi1)
#endif
#ifdef __BMI2__
                                             | bit(InstructionSet::Bmi2)
#endif
#ifdef __LZCNT__
                                             | bit(InstructionSet::Lzcnt)
#endif
#ifdef __MOVBE__
                                             | bit(InstructionSet::Movbe)
#endif
#ifdef __AVX512F__
                                             | bit(InstructionSet::Avx512f)
#endif
#ifdef __AVX512CD__
                                             | bit(InstructionSet::Avx512cd)
#endif
#ifdef __AVX512BW__
                                             | bit(InstructionSet::Avx512bw)
#endif
#ifdef __AVX512DQ__
                                             | bit(InstructionSet::Avx512dq)
#endif
#ifdef __AVX512VL__
                                             | bit(InstructionSet::Avx512vl)
#endif
#ifdef __AVX512IFMA__
                                             | bit(InstructionSet::Avx512ifma)
#endif
#ifdef __AVX512VBMI__
                                             | bit(InstructionSet::Avx512vbmi)
#endif
#ifdef __AVX512VBMI2__
                                             | bit(InstructionSet::Avx512vbmi2)
#endif
#ifdef __AVX512VNNI__
                                             | bit(InstructionSet::Avx512vnni)
#endif
#ifdef __AVX512BITALG__
                                             | bit(InstructionSet::Avx512bitalg)
#endif
#ifdef __AVX512VPOPCNTDQ__
                                             | bit(InstructionSet::Avx512vpopcntdq)
#endif
    ;

constinit const char* const kArchitecture = WHIT_ARCH;

}  // namespace whit
