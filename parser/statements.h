// The grammar of a scene file as one table: a row a directive.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/parameter.h"
#include "parser/lexer.h"

namespace whit {

class SceneBuilder;
struct Statement;

/// Where a directive may stand: before WorldBegin, after it, or in both places.
enum class Block : uint8_t { Options, World, Both };

/// What stands behind a directive, in this order: strings, a bare word, numbers, parameters.
struct ArgumentRule {
  uint8_t min_strings = 0, max_strings = 0;
  bool word = false;
  uint8_t numbers = 0;
  bool parameters = false;
  std::string_view usage = {};  ///< The same for people.
};

/// One directive: its name, its arguments, where it is allowed, what it does.
struct StatementRow {
  std::string_view name;
  ArgumentRule arguments;
  Block block;
  void (SceneBuilder::*handler)(Statement&);
  std::string_view doc;  ///< What it does, for people.
  int8_t nesting = 0;    ///< 1 when it opens a block, -1 when it closes one.
};

/// A statement as it was read.
struct Statement {
  const StatementRow* row = nullptr;
  SourcePos where;                 ///< The directive.
  uint64_t end = 0;                ///< The byte behind its last token.
  std::vector<std::string> names;  ///< The values of its strings that are no parameters.
  std::vector<SourcePos> names_at;
  std::string word;
  std::array<double, 16> numbers{};
  SourcePos arguments_at;  ///< The first argument, or the directive when there is none.
  ParameterList parameters;
};

/// The whole table.
std::span<const StatementRow> statements();

/// The row of a directive; null when there is no such directive.
const StatementRow* find_statement(std::string_view name);

/// True for the name of a directive.
bool is_directive(std::string_view name);

/// True also for one of another version of pbrt, in other case, or misspelt: what a scene may begin with.
bool resembles_directive(std::string_view word);

enum class ReadResult : uint8_t {
  Good,    ///< A statement.
  Broken,  ///< It had a mistake of syntax, was reported and passed over; `where` and `end` say where it was.
  End,     ///< The end of the file.
};

/// Reads the next statement and checks it against its row.
ReadResult read_statement(Lexer& lexer, Statement& out);

}  // namespace whit
