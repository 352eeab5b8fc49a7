// A picture as a texture, filtered over the footprint (EWA or trilinear) with pbrt-v3's filters, or not filtered. The
// file is decoded when a ray first meets it.
#include "core/image/image.h"
#include "core/image/signature.h"
#include "core/image/texture_store.h"
#include "plugins/shared/texture_channels.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {
namespace {

template <class T>
class ImageMap : public Texture2D<T> {
 public:
  FileName filename;
  Choice wrap;  // in the order of WrapMode
  std::optional<bool> gamma;
  float scale = 1, maxanisotropy = 8;
  bool trilinear = false;
  Choice filter;  // in the order of TextureFilter

  EffectSet effects() const override {
    return kind_of_filter() == TextureFilter::Point ? EffectSet{} : Texture2D<T>::effects();
  }

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (filename.empty()) diagnostics.error(statement, "imagemap needs a \"string filename\"");
  }

  bool read(Diagnostics& diagnostics, SourcePos statement) override {
    if (!Texture2D<T>::read(diagnostics, statement)) return false;
    if (begins_like_a_picture(filename.path)) return true;
    const Result<ImageInfo> info = probe_image(filename.path);
    if (!info.ok()) diagnostics.file_error(filename.where, info.error);
    return info.ok();
  }

  bool prepare(const PrepareContext& ctx) override {
    TextureSpec spec;
    spec.path = filename.path;
    spec.kind = kChannels<T> == 1 ? TextureKind::Float : TextureKind::Rgb;
    spec.wrap = static_cast<WrapMode>(wrap.index);
    spec.gamma = gamma;
    spec.scale = scale;
    spec.filter = kind_of_filter();
    spec.max_anisotropy = maxanisotropy;
    image_ = ctx.textures->add(spec, filename.where);
    return Texture2D<T>::prepare(ctx);
  }

  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const MappedPoints m = this->map_.map(s);
    if constexpr (kChannels<T> == 1) image_->lookup_float(s.n, m.s, m.t, m.dsdx, m.dtdx, m.dsdy, m.dtdy, out);
    else image_->lookup(s.n, m.s, m.t, m.dsdx, m.dtdx, m.dsdy, m.dtdy, out.r, out.g, out.b);
  }

 private:
  TextureFilter kind_of_filter() const {
    const auto chosen = static_cast<TextureFilter>(filter.index);
    return trilinear && chosen == TextureFilter::Ewa ? TextureFilter::Trilinear : chosen;
  }

  const ImageTexture* image_ = nullptr;
};

constexpr const char* kDoc = "A picture, looked up by texture coordinates; t = 0 is its bottom row.";

template <class T>
class RegisterImageMap : public Register2D<ImageMap<T>, T> {
  using I = ImageMap<T>;

 public:
  RegisterImageMap()
      : Register2D<I, T>(
            "imagemap", kDoc,
            param(&I::filename, "filename", Unit::None,
                  "The picture's file, in any format that OpenImageIO reads. Required."),
            choice(&I::wrap, "wrap", {"repeat", "black", "clamp"},
                   "What lies outside the unit square: the picture again, black, or its border."),
            param(&I::gamma, "gamma", Unit::None,
                  "Decodes sRGB. By default true for png and tga files, for others what the file says of itself, else "
                  "true "
                  "for 8-bit integers and false for all other numbers."),
            param(&I::scale, "scale", 1.0f, Unit::None, "Multiplies every value, after decoding."),
            param(&I::trilinear, "trilinear", false, Unit::None,
                  "pbrt-v3's way to ask for the trilinear filter; counts unless \"filter\" is \"point\"."),
            choice(
                &I::filter, "filter", {"ewa", "trilinear", "point"},
                "Averages over elliptic footprints; over square ones, which is faster, but blurred at grazing angles; "
                "or the nearest texel of the full resolution, without any filtering."),
            param(&I::maxanisotropy, "maxanisotropy", 8.0f, Unit::None,
                  "The most by which an elliptic footprint may be longer than wide; more is sharper and slower.",
                  kPositive)) {}
};

const RegisterImageMap<float> imagemap_float;
const RegisterImageMap<RGB> imagemap_spectrum;

}  // namespace
}  // namespace whit
