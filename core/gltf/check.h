// The checks of a glTF document, made before anything else looks at it: every value is of the type, in the range and,
// where it is an index, of a thing that exists. What is wrong is collected with its JSON pointer.
//
// Source: the glTF 2.0 specification and its JSON schemas.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostics.h"

namespace whit::gltf {

using Json = nlohmann::json;

/// What is wrong with one file: at most kMost errors, each once, and then how many more there are.
class Problems {
 public:
  static constexpr size_t kMost = 50;

  Problems(std::string shown, SourcePos where, Diagnostics& diagnostics)
      : shown_(std::move(shown)), where_(where), diagnostics_(diagnostics) {}
  ~Problems();
  Problems(const Problems&) = delete;
  Problems& operator=(const Problems&) = delete;

  /// "shown: /place: message". Without a remedy it is to export the file again. An empty place: the file as a whole.
  void error(const std::string& place, const std::string& message, std::string remedy = {});
  void file_error(const std::string& place, const std::string& message, std::string remedy = {});
  void warning(const std::string& place, const std::string& message, std::string remedy = {});
  /// Against the specification, and clear all the same: a warning, and an error where files are checked.
  void excused(const std::string& place, const std::string& message, std::string remedy);

  bool any() const { return errors_ > 0; }
  const std::string& shown() const { return shown_; }

 private:
  void add(ErrorClass kind, const std::string& place, const std::string& message, std::string remedy);
  std::string text(const std::string& place, const std::string& message) const;

  std::string shown_;
  SourcePos where_;
  Diagnostics& diagnostics_;
  size_t errors_ = 0;
  std::set<std::string> said_;
};

/// Things that an index may name: their JSON name and how many there are.
struct Things {
  const char* name = "";
  size_t count = 0;
};

/// Numbers that are allowed.
struct Bounds {
  double least = -std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::max();
  bool more_than_least = false;  ///< The least itself is not allowed.
};
inline constexpr Bounds kAnyNumber{}, kFraction{0, 1}, kNotNegative{0},
    kPositive{0, std::numeric_limits<double>::max(), true};
/// What a float holds: a strength times a colour, too.
inline constexpr Bounds kCoordinate{-1e30, 1e30}, kBright{0, 1e30}, kColorFactor{0, 1e6};

/// A value of the document and the way to it. Its functions report what is wrong and return what can be used anyway. Where
/// a whole number is wanted and the file writes 3.0, it becomes 3.
class Item {
 public:
  Item(Json& value, Problems& problems) : value_(&value), problems_(&problems) {}
  Item(const Item& up, std::string_view key, Json& value)
      : value_(&value), problems_(up.problems_), up_(&up), key_(key) {}
  Item(const Item& up, size_t index, Json& value) : value_(&value), problems_(up.problems_), up_(&up), index_(index) {}

  Json& value() const { return *value_; }
  Problems& problems() const { return *problems_; }
  /// A JSON pointer; of a member, with its name.
  std::string place() const;
  std::string place(std::string_view key) const;
  void error(const std::string& message, std::string remedy = {}) const;
  void error_at(std::string_view key, const std::string& message, std::string remedy = {}) const;

  bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  /// Reports where the value is not an object.
  bool is_object() const;

  /// Calls body with the member if it is there, and an object.
  void object(const char* key, const std::function<void(Item)>& body) const;
  /// Calls body with each element of an array of objects, if it is there.
  void objects(const char* key, const std::function<void(Item, size_t)>& body) const;
  /// Calls body with each member of an object, or element of an array, whatever these are.
  void members(const std::function<void(Item, const std::string&)>& body) const;
  void elements(const char* key, const std::function<void(Item, size_t)>& body) const;

  enum class Need { Optional, Required };
  std::optional<double> number(const char* key, Bounds bounds = {}, Need need = Need::Optional) const;
  std::optional<uint64_t> integer(const char* key, uint64_t least, uint64_t most, Need need = Need::Optional) const;
  /// The index of a thing that exists, or -1.
  int index(const char* key, Things things, Need need = Need::Optional) const;
  /// All are indices of things that exist, and none is there twice.
  std::vector<int> indices(const char* key, Things things, Need need = Need::Optional) const;
  /// As many numbers as one of the sizes says; else, or when the member is not there, none.
  std::vector<double> numbers(const char* key, size_t size, Bounds bounds = {}) const;
  std::vector<double> any_numbers(const char* key, Bounds bounds) const;
  std::optional<std::string> text(const char* key, Need need = Need::Optional) const;
  /// The place of the member's text in the choices, or -1.
  int choice(const char* key, const std::vector<const char*>& choices, Need need = Need::Optional) const;
  /// The same of a number.
  int choice(const char* key, const std::vector<uint64_t>& choices, Need need = Need::Optional) const;
  bool boolean(const char* key, bool otherwise = false) const;

  /// The value itself as one of these.
  std::optional<double> as_number(Bounds bounds) const;
  std::optional<uint64_t> as_integer(uint64_t least, uint64_t most) const;
  int as_index(Things things) const;

 private:
  std::optional<Item> find(const char* key, Need need) const;
  void wrong_type(const char* wanted) const;

  Json* value_;
  Problems* problems_;
  const Item* up_ = nullptr;
  std::string_view key_;
  size_t index_ = 0;
};

/// Text of the file in a message: in quotes, short, and without characters that cannot be shown.
std::string shown_text(std::string_view text, size_t most = 60);

}  // namespace whit::gltf
