#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/gltf/check.h"

namespace whit::gltf {
namespace {

constexpr const char* kExportAgain = "the file is damaged, or what wrote it is wrong: export the model again";

std::string without_controls(std::string_view text) {
  std::string out(text);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return out;
}

/// A number as people write it.
std::string shown_number(double number) { return fmt::format("{}", number); }

std::string shown_value(const Json& value) {
  if (value.is_string()) return shown_text(value.get_ref<const std::string&>());
  if (value.is_number_float()) return shown_number(value.get<double>());
  if (value.is_primitive()) return value.dump();
  return std::string("an ") + value.type_name();
}

}  // namespace

std::string shown_text(std::string_view text, size_t most) {
  std::string out = without_controls(text.substr(0, most));
  // Not in the middle of a character.
  while (text.size() > most && !out.empty() && (out.back() & 0x80) != 0) out.pop_back();
  return '"' + out + (text.size() > most ? "...\"" : "\"");
}

Problems::~Problems() {
  if (errors_ > kMost) {
    diagnostics_.error(where_, fmt::format("{}: and {} more errors", shown_, errors_ - kMost), kExportAgain);
  }
}

std::string Problems::text(const std::string& place, const std::string& message) const {
  return place.empty() ? shown_ + ": " + message : shown_ + ": " + place + ": " + message;
}

void Problems::add(ErrorClass kind, const std::string& place, const std::string& message, std::string remedy) {
  const std::string whole = text(place, message);
  if (errors_ < kMost && !said_.insert(whole).second) return;
  if (++errors_ > kMost) return;
  if (remedy.empty()) remedy = kExportAgain;
  diagnostics_.add({Severity::Error, kind, where_, whole, std::move(remedy)});
}

void Problems::error(const std::string& place, const std::string& message, std::string remedy) {
  add(ErrorClass::Scene, place, message, std::move(remedy));
}

void Problems::file_error(const std::string& place, const std::string& message, std::string remedy) {
  add(ErrorClass::File, place, message, std::move(remedy));
}

void Problems::warning(const std::string& place, const std::string& message, std::string remedy) {
  diagnostics_.warning(where_, text(place, message), std::move(remedy));
}

void Problems::excused(const std::string& place, const std::string& message, std::string remedy) {
  diagnostics_.excused(where_, text(place, message), std::move(remedy));
}

std::string Item::place() const {
  if (!up_) return {};
  return key_.empty() ? up_->place() + '/' + std::to_string(index_) : up_->place(key_);
}

std::string Item::place(std::string_view key) const {
  std::string out = place() + '/';
  constexpr size_t kMost = 100;
  for (const char c : without_controls(key.substr(0, kMost))) {
    if (c == '~') out += "~0";
    else if (c == '/') out += "~1";
    else out += c;
  }
  return out;
}

void Item::error(const std::string& message, std::string remedy) const {
  problems_->error(place(), message, std::move(remedy));
}

void Item::error_at(std::string_view key, const std::string& message, std::string remedy) const {
  problems_->error(place(key), message, std::move(remedy));
}

void Item::wrong_type(const char* wanted) const {
  error(fmt::format("must be {}, and is {}", wanted, shown_value(*value_)));
}

bool Item::is_object() const {
  if (value_->is_object()) return true;
  wrong_type("an object");
  return false;
}

std::optional<Item> Item::find(const char* key, Need need) const {
  if (!value_->is_object()) return std::nullopt;
  const auto found = value_->find(key);
  if (found != value_->end()) return Item(*this, key, *found);
  if (need == Need::Required) error_at(key, "is missing");
  return std::nullopt;
}

void Item::object(const char* key, const std::function<void(Item)>& body) const {
  const auto item = find(key, Need::Optional);
  if (item && item->is_object()) body(*item);
}

void Item::elements(const char* key, const std::function<void(Item, size_t)>& body) const {
  const auto item = find(key, Need::Optional);
  if (!item) return;
  if (!item->value_->is_array()) return item->wrong_type("an array");
  for (size_t i = 0; i < item->value_->size(); ++i) body(Item(*item, i, (*item->value_)[i]), i);
}

void Item::objects(const char* key, const std::function<void(Item, size_t)>& body) const {
  elements(key, [&](const Item& element, size_t i) {
    if (element.is_object()) body(element, i);
  });
}

void Item::members(const std::function<void(Item, const std::string&)>& body) const {
  if (!value_->is_object()) return;
  for (auto it = value_->begin(); it != value_->end(); ++it) body(Item(*this, it.key(), it.value()), it.key());
}

std::optional<double> Item::as_number(Bounds bounds) const {
  if (!value_->is_number()) return wrong_type("a number"), std::nullopt;
  const double number = value_->get<double>();
  if (!std::isfinite(number)) return error("is not a finite number"), std::nullopt;
  if (number < bounds.least || number > bounds.most || (bounds.more_than_least && number == bounds.least)) {
    const bool low = number <= bounds.least;
    error(fmt::format("must be {} {}, and is {}", low ? (bounds.more_than_least ? "above" : "at least") : "at most",
                      shown_number(low ? bounds.least : bounds.most), shown_number(number)));
    return std::nullopt;
  }
  return number;
}

std::optional<uint64_t> Item::as_integer(uint64_t least, uint64_t most) const {
  if (!value_->is_number()) return wrong_type("a whole number"), std::nullopt;
  constexpr double kExact = 9007199254740992;  // 2^53: above it not every whole number is a double.
  if (value_->is_number_float()) {
    const double number = value_->get<double>();
    if (number != std::floor(number) || std::abs(number) > kExact) return wrong_type("a whole number"), std::nullopt;
    *value_ = static_cast<int64_t>(number);
  }
  const bool negative = !value_->is_number_unsigned() && value_->get<int64_t>() < 0;
  const uint64_t number = negative ? 0 : value_->get<uint64_t>();
  if (negative || number < least)
    return error(fmt::format("must be at least {}, and is {}", least, value_->dump())), std::nullopt;
  if (number > most) return error(fmt::format("must be at most {}, and is {}", most, number)), std::nullopt;
  return number;
}

int Item::as_index(Things things) const {
  constexpr uint64_t kMost = 1u << 31;
  const auto number = as_integer(0, kMost);
  if (!number) return -1;
  if (*number < things.count) return static_cast<int>(*number);
  if (things.count == 0) error(fmt::format("is {}, and the file has no {}", *number, things.name));
  else error(fmt::format("is {}, and the last of the file's {} is {}", *number, things.name, things.count - 1));
  return -1;
}

std::optional<double> Item::number(const char* key, Bounds bounds, Need need) const {
  const auto item = find(key, need);
  return item ? item->as_number(bounds) : std::nullopt;
}

std::optional<uint64_t> Item::integer(const char* key, uint64_t least, uint64_t most, Need need) const {
  const auto item = find(key, need);
  return item ? item->as_integer(least, most) : std::nullopt;
}

int Item::index(const char* key, Things things, Need need) const {
  const auto item = find(key, need);
  return item ? item->as_index(things) : -1;
}

std::vector<int> Item::indices(const char* key, Things things, Need need) const {
  std::vector<int> out;
  if (!find(key, need)) return out;
  std::vector<bool> seen(things.count);
  elements(key, [&](const Item& element, size_t) {
    const int i = element.as_index(things);
    if (i < 0) return;
    if (seen[static_cast<size_t>(i)]) return element.error(fmt::format("{} is there twice", i));
    seen[static_cast<size_t>(i)] = true;
    out.push_back(i);
  });
  return out;
}

std::vector<double> Item::numbers(const char* key, size_t size, Bounds bounds) const {
  const auto item = find(key, Need::Optional);
  if (!item) return {};
  if (!item->value_->is_array() || item->value_->size() != size) {
    const std::string wanted = fmt::format("an array of {} numbers", size);
    if (!item->value_->is_array()) item->wrong_type(wanted.c_str());
    else item->error(fmt::format("must be {}, and has {}", wanted, item->value_->size()));
    return {};
  }
  std::vector<double> out;
  for (size_t i = 0; i < size; ++i) {
    const auto number = Item(*item, i, (*item->value_)[i]).as_number(bounds);
    if (number) out.push_back(*number);
  }
  if (out.size() != size) out.clear();
  return out;
}

std::vector<double> Item::any_numbers(const char* key, Bounds bounds) const {
  std::vector<double> out;
  elements(key, [&](const Item& element, size_t) { out.push_back(element.as_number(bounds).value_or(0)); });
  return out;
}

std::optional<std::string> Item::text(const char* key, Need need) const {
  const auto item = find(key, need);
  if (!item) return std::nullopt;
  if (!item->value_->is_string()) return item->wrong_type("a string"), std::nullopt;
  return item->value_->get<std::string>();
}

int Item::choice(const char* key, const std::vector<const char*>& choices, Need need) const {
  const auto word = text(key, need);
  if (!word) return -1;
  const auto found = std::find(choices.begin(), choices.end(), *word);
  if (found != choices.end()) return static_cast<int>(found - choices.begin());
  error_at(key, fmt::format("must be one of {}, and is {}", fmt::join(choices, ", "), shown_text(*word)));
  return -1;
}

int Item::choice(const char* key, const std::vector<uint64_t>& choices, Need need) const {
  const auto number = integer(key, 0, std::numeric_limits<uint32_t>::max(), need);
  if (!number) return -1;
  const auto found = std::find(choices.begin(), choices.end(), *number);
  if (found != choices.end()) return static_cast<int>(found - choices.begin());
  error_at(key, fmt::format("must be one of {}, and is {}", fmt::join(choices, ", "), *number));
  return -1;
}

bool Item::boolean(const char* key, bool otherwise) const {
  const auto item = find(key, Need::Optional);
  if (!item) return otherwise;
  if (!item->value_->is_boolean()) return item->wrong_type("true or false"), otherwise;
  return item->value_->get<bool>();
}

}  // namespace whit::gltf
