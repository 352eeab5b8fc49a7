#include "tests/fuzz/shared/scene_mutator.h"

#include <algorithm>
#include <string>
#include <vector>

#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/scene_text.h"
#include "tests/fuzz/shared/scene_vocabulary.h"

namespace whit::fuzz {
namespace {

using Scene = std::vector<Tokens>;

template <class T>
auto place(const std::vector<T>& list, size_t i) {
  return list.begin() + static_cast<std::ptrdiff_t>(i);
}

/// Some token of a statement for which `wanted` holds; null where there is none.
template <class Wanted>
std::string* some_token(Tokens& statement, Dice& dice, const Wanted& wanted) {
  std::vector<std::string*> found;
  for (std::string& token : statement)
    if (wanted(token)) found.push_back(&token);
  return found.empty() ? nullptr : found[dice.below(found.size())];
}

// ---- Whole statements

void add_statement(Scene& scene, Dice& dice) {
  scene.insert(place(scene, dice.below(scene.size() + 1)), make_statement(dice));
}

void lose_statement(Scene& scene, Dice& dice) { scene.erase(place(scene, dice.below(scene.size()))); }

void double_statement(Scene& scene, Dice& dice) {
  const Tokens copy = scene[dice.below(scene.size())];
  scene.insert(place(scene, dice.below(scene.size() + 1)), copy);
}

void swap_statements(Scene& scene, Dice& dice) {
  std::swap(scene[dice.below(scene.size())], scene[dice.below(scene.size())]);
}

/// A block around some of the statements.
void enclose(Scene& scene, Dice& dice) {
  const size_t first = dice.below(scene.size()), last = first + dice.below(scene.size() - first) + 1;
  const std::string name = any_name(dice);
  const size_t kind = dice.below(3);
  scene.insert(place(scene, last), kind == 0   ? Tokens{"AttributeEnd"}
                                   : kind == 1 ? Tokens{"TransformEnd"}
                                               : Tokens{"ObjectEnd"});
  if (kind == 2) scene.insert(place(scene, last + 1), Tokens{"ObjectInstance", name});
  scene.insert(place(scene, first), kind == 0   ? Tokens{"AttributeBegin"}
                                    : kind == 1 ? Tokens{"TransformBegin"}
                                                : Tokens{"ObjectBegin", name});
}

// ---- Within one

void odd_value(Tokens& statement, Dice& dice) {
  if (std::string* token = some_token(statement, dice, is_number)) *token = odd_number(dice);
}

void add_parameter(Tokens& statement, Dice& dice) {
  const PluginInfo* info = plugin_of(statement);
  if (!info) return;
  const Tokens parameter = make_parameter(*info, dice);
  statement.insert(statement.end(), parameter.begin(), parameter.end());
}

void change_plugin(Tokens& statement, Dice& dice) {
  if (const PluginInfo* info = plugin_of(statement))
    statement[statement[0] == "Texture" ? 3 : 1] = other_plugin(*info, dice);
}

/// Another name where one stands that is no declaration.
void change_name(Tokens& statement, Dice& dice) {
  const auto is_name = [](const std::string& token) { return is_quoted(token) && token.find(' ') == token.npos; };
  if (std::string* token = some_token(statement, dice, is_name)) *token = any_name(dice);
}

void change_type(Tokens& statement, Dice& dice) {
  const auto declares = [](const std::string& token) { return is_quoted(token) && token.find(' ') != token.npos; };
  if (std::string* token = some_token(statement, dice, declares))
    *token = '"' + any_type(dice) + token->substr(token->find(' '));
}

/// The values between some brackets cut or doubled.
void change_list(Tokens& statement, Dice& dice) {
  std::string* const open = some_token(statement, dice, [](const std::string& token) { return token == "["; });
  if (!open) return;
  const auto first = statement.begin() + (open - statement.data()) + 1;
  const auto last = std::find(first, statement.end(), "]");
  if (first == last) return;
  const auto middle = first + static_cast<std::ptrdiff_t>(dice.below(static_cast<size_t>(last - first)));
  const Tokens part(first, middle + 1);
  if (dice.one_in(2)) statement.erase(first, middle + 1);
  else statement.insert(last, part.begin(), part.end());
}

void lose_token(Tokens& statement, Dice& dice) { statement.erase(place(statement, dice.below(statement.size()))); }

void mutate_statement(Tokens& statement, Dice& dice) {
  if (statement.empty()) return;
  using Mutation = void (*)(Tokens&, Dice&);
  static constexpr Mutation kMutations[] = {odd_value,     odd_value,   odd_value,   add_parameter, add_parameter,
                                            change_plugin, change_name, change_type, change_list,   lose_token};
  dice.one_of(kMutations)(statement, dice);
}

void mutate(Scene& scene, Dice& dice) {
  using Mutation = void (*)(Scene&, Dice&);
  static constexpr Mutation kMutations[] = {add_statement,    add_statement,   lose_statement,
                                            double_statement, swap_statements, enclose};
  if (scene.empty()) add_statement(scene, dice);
  if (dice.one_in(2)) mutate_statement(scene[dice.below(scene.size())], dice);
  else dice.one_of(kMutations)(scene, dice);
}

}  // namespace

size_t mutate_scene(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  Dice dice(seed);
  if (dice.one_in(8)) return LLVMFuzzerMutate(data, size, max_size);
  Scene scene = split_statements(text_of(data, size));
  for (size_t n = 1 + dice.below(4); n > 0; --n) mutate(scene, dice);
  return put_text(join_statements(scene), data, max_size);
}

size_t cross_scenes(std::span<const uint8_t> a, std::span<const uint8_t> b, uint8_t* out, size_t max_size,
                    unsigned seed) {
  Dice dice(seed);
  const Scene first = split_statements(text_of(a.data(), a.size())),
              second = split_statements(text_of(b.data(), b.size()));
  Scene mixed;
  for (size_t i = 0; i < std::max(first.size(), second.size()); ++i) {
    const Scene& from = dice.one_in(2) ? first : second;
    if (i < from.size()) mixed.push_back(from[i]);
  }
  return put_text(join_statements(mixed), out, max_size);
}

}  // namespace whit::fuzz
