// Everything that `whit help` can be asked about, by name.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace whit {

/// One thing: "sphere" of the group "shape".
struct Topic {
  std::string name;
  std::vector<std::string> aliases;
  std::function<void()> print;
};

/// Things of a kind.
struct TopicGroup {
  std::string name;                 ///< "shape", "statement".
  std::vector<std::string> others;  ///< Other names of the group: "shapes".
  std::vector<std::string> before;  ///< What may stand before a name beside these: the statement that takes it.
  std::vector<Topic> topics;
  bool spaced;  ///< An empty line between its topics.
};

/// All groups.
std::vector<TopicGroup> topic_groups();

}  // namespace whit
