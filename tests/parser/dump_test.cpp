// dump() of parser_test_support.h, and the test that it can tell scenes apart.
#include <sstream>

#include "tests/parser/parser_test_support.h"

namespace whit {

namespace {

void dump(std::ostream& out, const Parameter& p) {
  out << "  " << param_type_name(p.type) << " " << p.name << ":";
  for (const double v : p.numbers()) out << " " << v;
  for (const int32_t v : p.integers()) out << " " << v;
  for (const uint8_t v : p.bools()) out << (v ? " true" : " false");
  for (const std::string& v : p.strings()) out << " '" << v << "'";
  for (const TextureRef& v : p.textures()) out << " " << v.name << "/" << v.float_texture << "/" << v.spectrum_texture;
  out << "\n";
}

void dump(std::ostream& out, const char* kind, const Entity& e) {
  out << kind << " '" << e.plugin << "'\n";
  for (const Parameter& p : e.params) dump(out, p);
}

}  // namespace

std::string dump(const SceneDescription& scene) {
  std::ostringstream out;
  out.precision(17);
  dump(out, "camera", scene.camera);
  dump(out, "film", scene.film);
  dump(out, "filter", scene.filter);
  dump(out, "sampler", scene.sampler);
  dump(out, "integrator", scene.integrator);
  dump(out, "accelerator", scene.accelerator);
  out << scene.camera_transform << " " << scene.time_start << " " << scene.time_end << "\n";
  for (size_t i = 0; i < scene.transforms.size(); ++i)
    out << "transform " << scene.transforms[i].start << scene.transforms[i].end;
  for (const TextureDescription& t : scene.textures) {
    dump(out, "texture", t);
    out << t.name << " " << t.spectrum << " " << t.transform << "\n";
  }
  for (const MaterialDescription& m : scene.materials) {
    dump(out, "material", m);
    out << m.name << "\n";
    for (const auto& [name, index] : m.named) out << "  uses " << name << " " << index << "\n";
  }
  for (const LightDescription& l : scene.lights) {
    dump(out, "light", l);
    out << l.transform << "\n";
  }
  for (const Entity& a : scene.area_lights) dump(out, "area light", a);
  for (const ShapeDescription& s : scene.shapes) {
    dump(out, "shape", s);
    out << s.transform << " " << s.material << " " << s.area_light << " " << s.object << " " << s.reverse_orientation
        << "\n";
  }
  for (const ObjectDescription& o : scene.objects) out << "object " << o.name << "\n";
  for (const InstanceDescription& i : scene.instances) out << "instance " << i.object << " " << i.transform << "\n";
  for (const UnreadFile& u : scene.unread_files) out << "unread " << u.path << " " << u.object << "\n";
  for (const MediumDescription& m : scene.media) {
    dump(out, "medium", m);
    out << m.name << "\n";
  }
  for (const MediumUse& use : scene.media_uses) out << "inside or outside " << use.name << " " << use.medium << "\n";
  out << scene.folder << "\n";
  return out.str();
}

TEST(Dump, TellsScenesApart) {
  const std::string one = dump(Parsed(in_world("Shape \"sphere\"")).scene());
  EXPECT_EQ(one, dump(Parsed("WorldBegin   # moved\n\n Shape \"sphere\"  WorldEnd").scene()));
  EXPECT_NE(one, dump(Parsed(in_world("Translate 0 0 1 Shape \"sphere\"")).scene()));
}

}  // namespace whit
