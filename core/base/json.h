// JSON values under construction, for whoever writes them or makes something else of them.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace whit {

/// A value of JSON; null by default. Whatever a value can be made of converts to it.
struct Json {
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;  ///< Written in this order.

  std::variant<std::monostate, bool, int64_t, double, std::string, Array, Object> value;

  Json() = default;
  Json(bool truth) : value(truth) {}
  template <std::integral T>
  Json(T number) : value(static_cast<int64_t>(number)) {}
  Json(double number) : value(number) {}
  Json(const char* text) : value(std::string(text)) {}
  Json(std::string text) : value(std::move(text)) {}
  Json(std::string_view text) : value(std::string(text)) {}
  Json(const std::vector<std::string>& texts) : value(Array(texts.begin(), texts.end())) {}
  Json(Array elements) : value(std::move(elements)) {}
  Json(Object members) : value(std::move(members)) {}
};

}  // namespace whit
