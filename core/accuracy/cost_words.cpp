#include "core/accuracy/cost_words.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <fstream>

#include "core/base/file_names.h"

namespace whit {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

const char* vectors() {
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("avx512f")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  if (__builtin_cpu_supports("avx")) return "AVX";
  return "SSE";
#else
  return "128-bit vectors";
#endif
}

}  // namespace

std::string cost_command(const CostRequest& request, int samples, const std::string& flags) {
  std::string command =
      fmt::format("{} {} --spp {}", shell_word(request.program), shell_word(request.scene_path), samples);
  if (request.threads > 0) command += fmt::format(" --nthreads {}", request.threads);
  return flags.empty() ? command : command + " " + flags;
}

std::string machine_words(int threads) {
  const int used = threads > 0 ? threads : tbb::this_task_arena::max_concurrency();
  return fmt::format("{}, {} thread{}, {}", processor(), used, used == 1 ? "" : "s", vectors());
}

}  // namespace whit
