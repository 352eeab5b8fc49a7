#include "tests/fuzz/shared/json_mutator.h"

#include <string_view>

namespace whit::fuzz {
namespace {

using Json = nlohmann::json;

/// A container somewhere in it that is not empty: each step down is as likely as to stay. Null where there is none.
Json* some_container(Json& root, Dice& dice) {
  Json* at = nullptr;
  for (Json* next = &root; next->is_structured() && !next->empty();) {
    at = next;
    if (dice.one_in(4)) break;
    next = &*std::next(at->begin(), static_cast<std::ptrdiff_t>(dice.below(at->size())));
  }
  return at;
}

Json odd_json(Dice& dice) {
  static constexpr int64_t kIntegers[] = {0,
                                          1,
                                          -1,
                                          2,
                                          3,
                                          4,
                                          5,
                                          16,
                                          255,
                                          5120,
                                          5121,
                                          5123,
                                          5125,
                                          5126,
                                          65536,
                                          2147483647,
                                          4294967295,
                                          -2147483648LL,
                                          9223372036854775807LL};
  switch (dice.below(8)) {
    case 0: return nullptr;
    case 1: return dice.one_in(2);
    case 2: return Json::array();
    case 3: return Json::object();
    case 4: return dice.one_in(2) ? "" : "SCALAR";
    case 5: return dice.one_in(2) ? 1e30 : -0.5;
    default: return Json(dice.one_of(kIntegers));
  }
}

}  // namespace

void mutate_json(Json& root, Dice& dice) {
  Json* const in = some_container(root, dice);
  if (!in) return;
  const auto chosen = std::next(in->begin(), static_cast<std::ptrdiff_t>(dice.below(in->size())));
  switch (dice.below(6)) {
    case 0: in->erase(chosen); break;
    case 1:
      if (in->is_array()) in->push_back(Json(*chosen));
      break;
    case 2:
      if (Json* const other = some_container(root, dice)) *chosen = Json(*other->begin());
      break;
    default: *chosen = chosen->is_number() && dice.one_in(2) ? Json(dice.below(8)) : odd_json(dice);
  }
}

}  // namespace whit::fuzz
