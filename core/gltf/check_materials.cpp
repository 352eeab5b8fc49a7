// Materials, textures and their samplers.
#include <fmt/format.h>

#include <set>

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

using Need = Item::Need;

class MaterialCheck {
 public:
  explicit MaterialCheck(const CheckContext& c) : c_(c) {}

  void check(const Item& material) {
    material.object("pbrMetallicRoughness", [&](const Item& pbr) {
      fractions(pbr, "baseColorFactor", 4);
      fraction(pbr, "metallicFactor"), fraction(pbr, "roughnessFactor");
      texture(pbr, "baseColorTexture"), texture(pbr, "metallicRoughnessTexture");
    });
    material.object("normalTexture", [](const Item& info) { info.number("scale", kCoordinate); });
    material.object("occlusionTexture", [this](const Item& info) { fraction(info, "strength"); });
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) texture(material, key);
    material.numbers("emissiveFactor", 3, kColorFactor);
    material.choice("alphaMode", std::vector<const char*>{"OPAQUE", "MASK", "BLEND"});
    material.number("alphaCutoff", kBright);
    material.boolean("doubleSided");
    material.object("extensions", [&](const Item& extensions) { check_extensions_of(extensions); });
  }

 private:
  void check_extensions_of(const Item& all) {
    const auto extension = [&](const char* name, const auto& body) {
      all.object((std::string("KHR_materials_") + name).c_str(), [&](const Item& e) { body(e); });
    };
    extension("emissive_strength", [](const Item& e) { e.number("emissiveStrength", kBright); });
    extension("ior", [](const Item& e) { check_ior(e); });
    extension("transmission",
              [&](const Item& e) { fraction(e, "transmissionFactor"), texture(e, "transmissionTexture"); });
    extension("volume", [&](const Item& e) {
      e.number("thicknessFactor", kBright);
      e.number("attenuationDistance", kPositive);
      e.numbers("attenuationColor", 3, kBright);
      texture(e, "thicknessTexture");
    });
    extension("specular", [&](const Item& e) {
      fraction(e, "specularFactor");
      e.numbers("specularColorFactor", 3, kBright);
      texture(e, "specularTexture"), texture(e, "specularColorTexture");
    });
    extension("clearcoat", [&](const Item& e) {
      fraction(e, "clearcoatFactor"), fraction(e, "clearcoatRoughnessFactor");
      texture(e, "clearcoatTexture"), texture(e, "clearcoatRoughnessTexture"), texture(e, "clearcoatNormalTexture");
    });
    extension("sheen", [&](const Item& e) {
      fractions(e, "sheenColorFactor", 3), fraction(e, "sheenRoughnessFactor");
      texture(e, "sheenColorTexture"), texture(e, "sheenRoughnessTexture");
    });
    extension("anisotropy", [&](const Item& e) {
      fraction(e, "anisotropyStrength"), e.number("anisotropyRotation", kCoordinate);
      texture(e, "anisotropyTexture");
    });
  }

  /// At least 1; 0 stands for a surface that reflects everything.
  static void check_ior(const Item& e) {
    const auto ior = e.number("ior", kBright);
    if (ior && *ior != 0 && *ior < 1) e.error_at("ior", fmt::format("must be 0 or at least 1, and is {}", *ior));
  }

  /// Exporters round 1 to a little more; and some write what they like. It is brought to [0, 1].
  void fraction(const Item& item, const char* key) {
    const auto number = item.number(key);
    if (number) item.value()[key] = into_range(item, key, *number);
  }
  void fractions(const Item& item, const char* key, size_t size) {
    const std::vector<double> numbers = item.numbers(key, size);
    for (size_t i = 0; i < numbers.size(); ++i) item.value()[key][i] = into_range(item, key, numbers[i]);
  }
  static double into_range(const Item& item, const char* key, double number) {
    if (number >= 0 && number <= 1) return number;
    item.problems().excused(item.place(key), fmt::format("must be from 0 to 1, and is {}", number),
                            number < 0 ? "0 is taken" : "1 is taken");
    return number < 0 ? 0 : 1;
  }

  void texture(const Item& item, const char* key) {
    item.object(key, [&](const Item& info) {
      info.index("index", c_.counts.textures, Need::Required);
      check_set(info);
      info.object("extensions", [&](const Item& extensions) {
        extensions.object("KHR_texture_transform", [&](const Item& transform) {
          transform.numbers("offset", 2, kCoordinate), transform.numbers("scale", 2, kCoordinate);
          transform.number("rotation", kCoordinate);
          check_set(transform);
        });
      });
    });
  }

  static void check_set(const Item& info) {
    const auto set = info.integer("texCoord", 0, 1000000);
    if (set && *set > 1)
      info.problems().warning(info.place("texCoord"), fmt::format("is {}, and the sets 0 and 1 are read", *set),
                              "the texture is left out");
  }

  const CheckContext& c_;
};

}  // namespace

void check_materials(const CheckContext& c) {
  MaterialCheck check(c);
  c.root.objects("materials", [&](const Item& material, size_t) { check.check(material); });
}

void check_textures(const CheckContext& c) {
  bool told = false;
  c.root.objects("textures", [&](const Item& texture, size_t) {
    texture.index("sampler", c.counts.samplers);
    texture.index("source", c.counts.images);
    texture.object("extensions", [&](const Item& extensions) {
      for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu"}) {
        extensions.object(name, [&](const Item& e) { e.index("source", c.counts.images); });
      }
      if (told || !extensions.has("KHR_texture_basisu") || texture.has("source")) return;
      told = true;
      extensions.problems().warning(texture.place(),
                                    "has only a picture of KHR_texture_basisu, which cannot be decoded",
                                    "re-export without KHR_texture_basisu");
    });
  });
  c.root.objects("samplers", [](const Item& sampler, size_t) {
    sampler.choice("magFilter", std::vector<uint64_t>{9728, 9729});
    sampler.choice("minFilter", std::vector<uint64_t>{9728, 9729, 9984, 9985, 9986, 9987});
    for (const char* wrap : {"wrapS", "wrapT"}) sampler.choice(wrap, std::vector<uint64_t>{10497, 33071, 33648});
  });
}

}  // namespace whit::gltf
