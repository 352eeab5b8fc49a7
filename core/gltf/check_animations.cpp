#include <fmt/format.h>

#include <map>
#include <set>

#include "core/gltf/check_parts.h"
#include "core/gltf/numbers.h"

namespace whit::gltf {
namespace {

using Need = Item::Need;

class AnimationCheck {
 public:
  explicit AnimationCheck(const CheckContext& c) : c_(c) {}

  void check(const Item& animation) {
    samplers_.clear(), targets_.clear();
    for (const char* key : {"channels", "samplers"})
      if (!animation.has(key)) animation.error_at(key, "is missing");
    animation.objects("samplers", [&](const Item& sampler, size_t i) {
      samplers_.resize(i + 1);
      samplers_[i] = read_sampler(sampler);
    });
    animation.objects("channels", [&](const Item& channel, size_t) { check_channel(channel); });
  }

 private:
  struct Sampler {
    uint64_t keys = 0;  ///< 0 where it is wrong.
    int output = -1;
    uint64_t values_for_key = 1;
  };

  Sampler read_sampler(const Item& sampler) {
    const int how = sampler.has("interpolation")
                        ? sampler.choice("interpolation", std::vector<const char*>{"LINEAR", "STEP", "CUBICSPLINE"})
                        : 0;
    const int input = check_accessor(c_, sampler, "input", floats_of(1), Need::Required);
    Sampler out;
    out.output = sampler.index("output", c_.counts.accessors, Need::Required);
    if (how < 0 || input < 0 || out.output < 0 || !check_times(sampler, input)) return out;
    out.keys = c_.buffers.accessors[static_cast<size_t>(input)].count;
    out.values_for_key = how == 2 ? 3 : 1;
    return out;
  }

  /// Times increase, from 0 or later on. Accessors that many samplers share are looked at once.
  bool check_times(const Item& sampler, int input) {
    const auto [known, fresh] = times_.try_emplace(input);
    if (fresh) known->second = problem_of_times(input);
    if (known->second.empty()) return true;
    sampler.error_at("input", known->second);
    return false;
  }

  std::string problem_of_times(int input) const {
    std::vector<float> times;
    // What cannot be decoded is told by its own place.
    if (const std::string error = read_floats(c_.buffers, input, times); !error.empty()) return error;
    if (!times.empty() && times.front() < 0)
      return fmt::format("begins at {}, and times are not negative", times.front());
    for (size_t i = 1; i < times.size(); ++i) {
      if (!(times[i] > times[i - 1]))
        return fmt::format("must increase, and {} follows {} at number {}", times[i], times[i - 1], i);
    }
    return {};
  }

  void check_channel(const Item& channel) {
    const int sampler = channel.index("sampler", {"samplers", samplers_.size()}, Need::Required);
    if (!channel.has("target")) channel.error_at("target", "is missing");
    channel.object("target", [&](const Item& target) {
      const int node = target.index("node", c_.counts.nodes);
      // Extensions have paths of their own, without a node.
      if (target.has("extensions") && !target.has("node")) return;
      const int path = target.choice("path", std::vector<const char*>{"translation", "rotation", "scale", "weights"},
                                     Need::Required);
      if (node < 0 || path < 0) return;
      if (!targets_.emplace(node, path).second)
        target.error(fmt::format("node {} has another channel of this path", node));
      if (sampler >= 0) check_output(channel, samplers_[static_cast<size_t>(sampler)], node, path);
    });
  }

  void check_output(const Item& channel, const Sampler& sampler, int node, int path) {
    if (sampler.keys == 0) return;
    static const Wanted* const kWanted[] = {&floats_of(3), &fractions_of(4), &floats_of(3), &fractions_of(1)};
    Json index = sampler.output;
    if (check_accessor(c_, Item(channel, "sampler", index), *kWanted[path]) < 0) return;
    const int mesh = c_.node_mesh[static_cast<size_t>(node)];
    const uint64_t targets = mesh < 0 ? 0 : c_.mesh_targets[static_cast<size_t>(mesh)];
    if (path == 3 && targets == 0) return channel.error_at("target", fmt::format("node {} has no morph targets", node));
    const uint64_t wanted = sampler.keys * sampler.values_for_key * (path == 3 ? targets : 1);
    const uint64_t count = c_.buffers.accessors[static_cast<size_t>(sampler.output)].count;
    if (count != wanted)
      channel.error_at("sampler",
                       fmt::format("has {} output values, and its {} times ask for {}", count, sampler.keys, wanted));
  }

  const CheckContext& c_;
  std::vector<Sampler> samplers_;
  std::set<std::pair<int, int>> targets_;
  std::map<int, std::string> times_;
};

}  // namespace

void check_animations(const CheckContext& c) {
  AnimationCheck check(c);
  c.root.objects("animations", [&](const Item& animation, size_t) { check.check(animation); });
}

}  // namespace whit::gltf
