// Where reading ends: what no honest scene reaches, and what would go on for ever or take all memory. docs/limits.md
// lists them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace whit {

/// A limit with the name by which messages and docs/limits.md call it.
struct Limit {
  const char* name;
  uint64_t most;
};

inline constexpr Limit kIncludeDepth{"include-depth", 256};   ///< Files that include one another, the main file too.
inline constexpr Limit kIncludes{"includes", 500'000};        ///< Of a scene in all, a file counted each time.
inline constexpr Limit kPipedBytes{"piped-bytes", 1u << 30};  ///< Of a scene that comes through a pipe.
inline constexpr Limit kSpectrumBytes{"spectrum-bytes", 1u << 26};  ///< Of a file of wavelengths and values.
inline constexpr Limit kBsdfBytes{"bsdf-bytes", 1u << 30};          ///< Of a tabulated BSDF.
inline constexpr Limit kPlyHeaderBytes{"ply-header-bytes", 1u << 20};
inline constexpr Limit kGltfJsonBytes{"gltf-json-bytes",
                                      1u << 30};                ///< Of a .gltf file, or of that part of a .glb one.
inline constexpr Limit kPolicyBytes{"policy-bytes", 1u << 26};  ///< Of a policy for `whit diff`.

inline constexpr Limit kLimits[] = {kIncludeDepth, kIncludes,       kPipedBytes,    kSpectrumBytes,
                                    kBsdfBytes,    kPlyHeaderBytes, kGltfJsonBytes, kPolicyBytes};

/// What is said of a file that is larger: "it has more than 67108864 bytes, the limit spectrum-bytes".
std::string more_bytes_than(const Limit& limit);

/// What is said of devices, pipes and sockets, which may have no end.
inline constexpr const char* kNotRegular = "it is not a regular file";

/// Why a file cannot be read, or "": it is not there, it is a folder, it is no regular file, nobody may. Waits for nobody,
/// and leaves it unread.
std::string why_unreadable(const std::string& path);

/// The whole of a regular file that is not too large; nothing, and the reason in `problem`, when it cannot be read, or
/// changes meanwhile.
std::optional<std::string> read_file(const std::string& path, const Limit& limit, std::string& problem);

}  // namespace whit
