// Which of Embree's instruction sets this processor has. Embree takes the word of whoever asks for one.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace whit::test {

/// Configurations of Embree's device, one for each instruction set that can be tested here; says which cannot.
inline std::vector<std::string> instruction_sets() {
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512vl");
  const std::pair<const char*, bool> sets[] = {{"isa=sse2", true},
                                               {"isa=sse4.2", __builtin_cpu_supports("sse4.2") != 0},
                                               {"isa=avx", __builtin_cpu_supports("avx") != 0},
                                               {"isa=avx2", avx2},
                                               {"isa=avx512", avx512}};
  std::vector<std::string> usable;
  for (const auto& [set, has] : sets) {
    if (has) usable.emplace_back(set);
    else std::printf("left out, for this processor does not have it: %s\n", set);
  }
  return usable;
}

}  // namespace whit::test
