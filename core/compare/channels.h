// What the channels of a picture are, by their names, and which of them a pattern chooses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace whit {

/// How the numbers of a channel may be compared.
enum class ChannelKind : uint8_t {
  Colour,     ///< Light or a reflectance: R, G and B of a layer, and Y.
  Data,       ///< Any number: normals, points, depths, alpha.
  Id,         ///< Numbers that stand for something: equal or not.
  Statistic,  ///< What is known of the samples: variances and how many there are. No part of the picture.
};

/// "R" and "Albedo.R" are colours, "N.X", "Z" and "A" data, "shape.id" and "CryptoShape00.r" ids, "variance.R" and
/// "samples" statistics.
ChannelKind channel_kind(const std::string& name);

/// What is before the last dot: "Albedo" of "Albedo.R", "" of "R".
std::string layer_of(const std::string& channel);

/// True for a channel of a cryptomatte that holds the ids of what covers most of its pixels: "CryptoShape00.r".
bool is_first_matte_rank(const std::string& channel);
/// True for all channels of cryptomattes.
bool is_matte(const std::string& channel);

/// True for depths among a picture's channels: "Z" and "left.Z", but not "N.Z", beside which there is "N.X".
bool is_depth(const std::string& channel, const std::vector<std::string>& all);

/// True for NaN and infinity where they mean nothing. Two infinities mean something: of a depth that nothing is there, of a
/// statistic that it is not known.
bool is_fault(const std::string& channel, const std::vector<std::string>& all, float value);

/// True when `text` is what a pattern of * and ? says, all of it: "Albedo.*", "?".
bool matches(const std::string& pattern, const std::string& text);

/// The patterns of a list with commas between, without the spaces around them.
std::vector<std::string> split_patterns(const std::string& patterns);

/// True for what one of several patterns with commas between says, "R,G,B,Albedo.*", and none of those after a "!":
/// "!variance.*" alone is all but these. No pattern is all.
bool matches_any(const std::string& patterns, const std::string& text);

}  // namespace whit
