#include "tools/whit/json.h"

#include <nlohmann/json.hpp>

namespace whit {
namespace {

using Written = nlohmann::ordered_json;

Written convert(const Json& json) {
  struct Visitor {
    Written operator()(std::monostate) const { return nullptr; }
    Written operator()(bool truth) const { return truth; }
    Written operator()(int64_t number) const { return number; }
    Written operator()(double number) const { return number; }
    Written operator()(const std::string& text) const { return text; }
    Written operator()(const Json::Array& elements) const {
      Written out = Written::array();
      for (const Json& element : elements) out.push_back(convert(element));
      return out;
    }
    Written operator()(const Json::Object& members) const {
      Written out = Written::object();
      for (const auto& [name, member] : members) out[name] = convert(member);
      return out;
    }
  };
  return std::visit(Visitor(), json.value);
}

}  // namespace

std::string to_text(const Json& json) { return convert(json).dump(1, ' ', false, Written::error_handler_t::replace); }

}  // namespace whit
