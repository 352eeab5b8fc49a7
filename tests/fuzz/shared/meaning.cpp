#include "tests/fuzz/shared/meaning.h"

#include <bit>
#include <utility>
#include <variant>

namespace whit::fuzz {
namespace {

/// Values one after another, each with what keeps it apart from the next.
class Words {
 public:
  void add(const std::string& text) { out_ += std::to_string(text.size()) + ':' + text + ' '; }
  void add(double number) { out_ += std::to_string(std::bit_cast<uint64_t>(number)) + ' '; }
  void add(int number) { out_ += std::to_string(number) + ' '; }
  void add(bool yes) { out_ += yes ? "yes " : "no "; }
  void add(uint8_t number) { add(int{number}); }
  void add(const TextureRef& t) { add(t.name), add(t.float_texture), add(t.spectrum_texture); }
  void add(const Mat4d& m) {
    for (int i = 0; i < 16; ++i) add(m.x[i / 4][i % 4]);
  }
  void add(const Parameter& p) {
    add(param_type_name(p.type)), add(p.name);
    std::visit([this](const auto& values) { add_all(values); }, p.values);
  }
  void add(const Entity& e) { add(e.plugin), add_all(e.params); }
  void add(const TextureDescription& t) {
    add(static_cast<const Entity&>(t)), add(t.name), add(t.spectrum), add(t.transform), add(t.block);
  }
  void add(const MaterialDescription& m) {
    add(static_cast<const Entity&>(m)), add(m.name), add(m.block);
    for (const auto& [name, index] : m.named) add(name), add(index);
  }
  void add(const MediumDescription& m) { add(static_cast<const Entity&>(m)), add(m.name); }
  void add(const LightDescription& l) { add(static_cast<const Entity&>(l)), add(l.transform); }
  void add(const ShapeDescription& s) {
    add(static_cast<const Entity&>(s)), add(s.transform), add(s.material), add(s.area_light), add(s.object);
    add(s.reverse_orientation);
  }
  void add(const ObjectDescription& o) { add(o.name); }
  void add(const InstanceDescription& i) { add(i.object), add(i.transform); }
  void add(const UnreadFile& f) { add(f.path), add(f.object); }
  void add(const MediumUse& m) { add(m.name), add(m.medium); }
  void add(const CoordinateSystemDescription& c) { add(c.name), add(c.used); }

  template <class List>
  void add_all(const List& list) {
    add(static_cast<int>(list.size()));
    for (const auto& item : list) add(item);
  }
  std::string take() { return std::move(out_); }

 private:
  void add(const char* text) { add(std::string(text)); }

  std::string out_;
};

}  // namespace

std::string meaning_of(const SceneDescription& s) {
  Words words;
  for (const Entity* e : {&s.camera, &s.film, &s.filter, &s.sampler, &s.integrator, &s.accelerator}) words.add(*e);
  words.add(s.camera_transform), words.add(s.time_start), words.add(s.time_end);
  for (size_t i = 0; i < s.transforms.size(); ++i) words.add(s.transforms[i].start), words.add(s.transforms[i].end);
  words.add_all(s.textures), words.add_all(s.materials), words.add_all(s.lights), words.add_all(s.area_lights);
  words.add_all(s.shapes), words.add_all(s.objects), words.add_all(s.instances), words.add_all(s.unread_files);
  words.add_all(s.media), words.add_all(s.media_uses), words.add_all(s.coordinate_systems);
  return words.take();
}

}  // namespace whit::fuzz
