#include "tests/fuzz/shared/ply_mutator.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/shared/fuzz.h"

namespace whit::fuzz {
namespace {

constexpr std::string_view kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
constexpr std::string_view kTypes[] = {"char",   "uchar", "short",  "ushort", "int",     "uint",    "float",
                                       "double", "int8",  "uint16", "int32",  "float32", "float64", "half"};
constexpr std::string_view kVertexProperties[] = {"x",    "y",     "z",         "nx",        "ny", "nz", "u",   "v",
                                                  "s",    "t",     "texture_u", "texture_v", "u1", "v1", "red", "green",
                                                  "blue", "alpha", "tx",        "ty",        "tz", "tw", "odd"};
constexpr std::string_view kElements[] = {"vertex", "face", "edge", "tristrips", ""};
constexpr std::string_view kCounts[] = {"0",
                                        "1",
                                        "2",
                                        "3",
                                        "4",
                                        "7",
                                        "-1",
                                        "255",
                                        "65536",
                                        "2147483648",
                                        "4294967296",
                                        "18446744073709551615",
                                        "18446744073709551616",
                                        "x"};

template <class List>
std::string_view any(Dice& dice, const List& list) {
  return dice.one_of(list);
}

size_t size_of(std::string_view type) {
  if (type.ends_with("char") || type.ends_with("int8")) return 1;
  if (type.ends_with("short") || type.ends_with("int16") || type == "half") return 2;
  return type == "double" || type == "float64" ? 8 : 4;
}

/// The values of a body, as its format has them.
class Body {
 public:
  Body(std::string_view format, Dice& dice) : format_(format), dice_(dice) {}

  void count(std::string_view type, unsigned n) {
    if (format_ == "ascii") text_ += std::to_string(n) + " ";
    else put(n, size_of(type));
  }
  /// An index or a coordinate, mostly small.
  void value(std::string_view type, bool is_index) {
    const bool is_real = type.starts_with("f") || type.starts_with("d");
    if (format_ == "ascii") {
      text_ += (is_index && !dice_.one_in(16) ? std::to_string(dice_.below(4)) : odd_number(dice_)) + " ";
    } else if (dice_.one_in(16)) {
      put(dice_.next(), size_of(type));
    } else if (is_real) {
      // The upper bytes of 0, 1, 2 and -1.5: enough digits for any of these.
      constexpr uint64_t kFloats[] = {0, 0x3f800000, 0x40000000, 0xbfc00000};
      constexpr uint64_t kDoubles[] = {0, 0x3ff0000000000000, 0x4000000000000000, 0xbff8000000000000};
      put((size_of(type) == 8 ? kDoubles : kFloats)[dice_.below(4)], size_of(type));
    } else {
      put(dice_.below(4), size_of(type));
    }
  }
  void end_line() {
    if (format_ == "ascii") text_ += "\n";
  }
  const std::string& text() const { return text_; }

 private:
  void put(uint64_t value, size_t bytes) {
    for (size_t i = 0; i < bytes; ++i) {
      const size_t at = format_ == "binary_big_endian" ? bytes - 1 - i : i;
      text_ += static_cast<char>(value >> (8 * at));
    }
  }

  std::string_view format_;
  Dice& dice_;
  std::string text_;
};

struct Property {
  std::string_view type, name;
  std::string_view list;  // type of the length; "" for a single value
};

std::vector<Property> vertex_properties(Dice& dice) {
  std::vector<Property> all;
  const size_t wanted = 3 + dice.below(8);
  for (size_t i = 0; i < wanted; ++i)
    all.push_back({any(dice, kTypes), kVertexProperties[i % std::size(kVertexProperties)], ""});
  for (size_t i = 3; i < wanted; ++i) all[i].name = any(dice, kVertexProperties);
  if (dice.one_in(4)) std::swap(all.front(), all.back());
  if (dice.one_in(16)) all[dice.below(wanted)].list = any(dice, kTypes);
  return all;
}

std::vector<Property> face_properties(Dice& dice) {
  std::vector<Property> all{{any(dice, kTypes), dice.one_in(2) ? "vertex_indices" : "vertex_index", any(dice, kTypes)}};
  if (dice.one_in(3)) all.push_back({any(dice, kTypes), "face_indices", dice.one_in(2) ? any(dice, kTypes) : ""});
  if (dice.one_in(3)) std::swap(all.front(), all.back());
  return all;
}

/// One element: its lines of the header, and its rows.
void add_element(std::string_view name, const std::vector<Property>& properties, Dice& dice, std::string& header,
                 Body& body) {
  const size_t rows = dice.below(5);
  header += "element " + std::string(name) + " " + std::to_string(rows) + "\n";
  for (const Property& p : properties) {
    header += "property ";
    if (!p.list.empty()) header += "list " + std::string(p.list) + " ";
    header += std::string(p.type) + " " + std::string(p.name) + "\n";
  }
  for (size_t row = 0; row < rows; ++row) {
    for (const Property& p : properties) {
      const unsigned n = p.list.empty() ? 1 : static_cast<unsigned>(2 + dice.below(4));
      if (!p.list.empty()) body.count(p.list, n);
      for (unsigned i = 0; i < n; ++i) body.value(p.type, !p.list.empty());
    }
    body.end_line();
  }
}

std::string new_file(Dice& dice) {
  const std::string_view format = any(dice, kFormats);
  std::string header = "ply\nformat " + std::string(format) + " 1.0\n";
  Body body(format, dice);
  const bool faces_first = dice.one_in(8);
  if (faces_first) add_element("face", face_properties(dice), dice, header, body);
  add_element("vertex", vertex_properties(dice), dice, header, body);
  if (dice.one_in(6)) add_element(any(dice, kElements), face_properties(dice), dice, header, body);
  if (!faces_first) add_element("face", face_properties(dice), dice, header, body);
  return header + "end_header\n" + body.text();
}

/// Another word in the place of one of a line, of the kind that stands there.
void exchange_word(std::string& line, Dice& dice) {
  std::vector<std::string> words;
  for (size_t at = 0; at < line.size();) {
    const size_t end = std::min(line.find(' ', at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  if (words.size() < 2) return;
  std::string& word = words[1 + dice.below(words.size() - 1)];
  if (words[0] == "format") word = any(dice, kFormats);
  else if (words[0] == "element") word = &word == &words[1] ? any(dice, kElements) : any(dice, kCounts);
  else word = &word == &words.back() ? any(dice, kVertexProperties) : any(dice, kTypes);
  line.clear();
  for (const std::string& w : words) line += (line.empty() ? "" : " ") + w;
}

/// A line of the header lost, doubled, moved or with another word.
std::string mutate_header(std::string_view header, Dice& dice) {
  std::vector<std::string> lines;
  for (size_t at = 0; at < header.size();) {
    const size_t end = std::min(header.find('\n', at), header.size());
    lines.emplace_back(header.substr(at, end - at));
    at = end + 1;
  }
  if (lines.empty()) return "ply\n";
  const size_t i = dice.below(lines.size()), j = dice.below(lines.size());
  switch (dice.below(8)) {
    case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i)); break;
    case 1: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(j), std::string(lines[i])); break;
    case 2: std::swap(lines[i], lines[j]); break;
    default: exchange_word(lines[i], dice);
  }
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

}  // namespace

size_t mutate_ply(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  constexpr std::string_view kEnd = "end_header\n";
  Dice dice(seed);
  if (dice.one_in(8)) return put_text(new_file(dice), data, max_size);
  const std::string text = text_of(data, size);
  const size_t end = text.find(kEnd);
  if (end == std::string::npos || dice.one_in(8)) return LLVMFuzzerMutate(data, size, max_size);
  const size_t body = end + kEnd.size();
  if (dice.one_in(2)) return put_text(mutate_header(text.substr(0, end), dice) + text.substr(end), data, max_size);
  if (text.find("\nformat ascii") < end && dice.one_in(2))
    return body + exchange_number(data + body, size - body, max_size - body, dice);
  const size_t room = size > body && dice.one_in(2) ? size - body : max_size - body;
  return room == 0 ? size : body + LLVMFuzzerMutate(data + body, size - body, room);
}

}  // namespace whit::fuzz
