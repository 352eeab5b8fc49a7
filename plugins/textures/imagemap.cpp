// A picture as a texture, filtered over the footprint (EWA or trilinear) with pbrt-v3's filters, or not filtered. The
// file is decoded when a ray first meets it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/image/image.h"
#include "core/image/picture_need.h"
#include "core/image/signature.h"
#include "core/image/texture_store.h"
#include "plugins/shared/texture_channels.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {
namespace {

constexpr WrapMode kWraps[] = {WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::Mirror};

template <class T>
class ImageMap : public Texture2D<T>, public NeedsMemory {
 public:
  FileName filename;
  Choice wrap, wrapu, wrapv;  // in the order of kWraps; the last two have "as wrap" first
  Choice channel;             // in the order of TextureChannel
  std::optional<bool> gamma;
  float scale = 1, maxanisotropy = 8;
  bool trilinear = false;
  Choice filter;  // in the order of TextureFilter

  EffectSet effects() const override {
    return kind_of_filter() == TextureFilter::Point ? EffectSet{} : Texture2D<T>::effects();
  }

  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all = Texture2D<T>::ineffective();
    if (wrapu.index > 0 && wrapv.index > 0) all.push_back({"wrap", "\"wrapu\" and \"wrapv\" go before it"});
    if (kind_of_filter() != TextureFilter::Ewa) all.push_back({"maxanisotropy", "the filter is not \"ewa\""});
    if (static_cast<TextureFilter>(filter.index) == TextureFilter::Point)
      all.push_back({"trilinear", "the \"filter\" is \"point\""});
    return all;
  }

  std::optional<TexelUse> texels_used(const ShadingBatch& s) const override {
    if (!image_ || !s.has_footprint()) return std::nullopt;
    const Result<ImageInfo> info = probe_image(bytes_ ? PictureFile(bytes_) : PictureFile(filename.path));
    if (!info.ok()) return std::nullopt;
    const MappedPoints m = this->map_.map(s);
    TexelUse use{info.value.width, info.value.height, s.arena->floats(s.n), s.arena->floats(s.n)};
    const auto w = static_cast<float>(use.width), h = static_cast<float>(use.height);
    for (int i = 0; i < s.n; ++i) {
      const float x = std::hypot(m.dsdx[i] * w, m.dtdx[i] * h), y = std::hypot(m.dsdy[i] * w, m.dtdy[i] * h);
      use.least[i] = std::min(x, y), use.most[i] = std::max(x, y);
    }
    return use;
  }

  void attach(std::shared_ptr<const Attachment> picture) override {
    bytes_ = std::dynamic_pointer_cast<const PictureBytes>(std::move(picture));
  }

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    Texture2D<T>::check(diagnostics, statement);
    if (filename.empty() && !bytes_) diagnostics.error(statement, "imagemap needs a \"string filename\"");
  }

  bool read(Diagnostics& diagnostics, SourcePos statement) override {
    if (!Texture2D<T>::read(diagnostics, statement)) return false;
    const PictureFile picture = bytes_ ? PictureFile(bytes_) : PictureFile(filename.path);
    if (begins_like_a_picture(picture)) return true;
    const Result<ImageInfo> info = probe_image(picture);
    if (!info.ok()) diagnostics.file_error(bytes_ ? statement : filename.where, info.error);
    return info.ok();
  }

  MemoryNeed memory_need(const MeshAttributes&) const override { return texture_need(spec()); }

  bool prepare(const PrepareContext& ctx) override {
    image_ = ctx.textures->add(spec(), bytes_ ? ctx.statement : filename.where);
    return Texture2D<T>::prepare(ctx);
  }

  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const MappedPoints m = this->map_.map(s);
    if constexpr (kChannels<T> == 1) image_->lookup_float(s.n, m.s, m.t, m.dsdx, m.dtdx, m.dsdy, m.dtdy, out);
    else image_->lookup(s.n, m.s, m.t, m.dsdx, m.dtdx, m.dsdy, m.dtdy, out.r, out.g, out.b);
  }

 private:
  TextureSpec spec() const {
    TextureSpec spec;
    spec.path = filename.path;
    spec.bytes = bytes_;
    spec.kind = kChannels<T> == 1 ? TextureKind::Float : TextureKind::Rgb;
    spec.channel = static_cast<TextureChannel>(channel.index);
    const auto along = [&](const Choice& axis) { return kWraps[axis.index > 0 ? axis.index - 1 : wrap.index]; };
    spec.wrap = wrap_of(along(wrapu), along(wrapv));
    spec.gamma = gamma;
    spec.scale = scale;
    spec.filter = kind_of_filter();
    spec.max_anisotropy = maxanisotropy;
    return spec;
  }

  TextureFilter kind_of_filter() const {
    const auto chosen = static_cast<TextureFilter>(filter.index);
    return trilinear && chosen == TextureFilter::Ewa ? TextureFilter::Trilinear : chosen;
  }

  std::shared_ptr<const PictureBytes> bytes_;
  const ImageTexture* image_ = nullptr;
};

constexpr const char* kDoc = "A picture, looked up by texture coordinates; t = 0 is its bottom row.";

template <class T>
class RegisterImageMap : public Register2D<ImageMap<T>, T> {
  using I = ImageMap<T>;

 public:
  template <class... OfOneKind>
  explicit RegisterImageMap(OfOneKind... of_one_kind)
      : Register2D<I, T>(
            "imagemap", kDoc,
            param(&I::filename, "filename", Unit::None,
                  "The picture's file, in any format that OpenImageIO reads. Required."),
            choice(&I::wrap, "wrap", {"repeat", "black", "clamp", "mirror"},
                   "What lies outside the unit square: the picture again, black, its border, or the picture mirrored."),
            choice(&I::wrapu, "wrapu", {"as wrap", "repeat", "black", "clamp", "mirror"}, "The same along s alone."),
            choice(&I::wrapv, "wrapv", {"as wrap", "repeat", "black", "clamp", "mirror"}, "The same along t alone."),
            of_one_kind...,
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

const RegisterImageMap<float> imagemap_float{choice(
    &ImageMap<float>::channel, "channel", {"luminance", "red", "green", "blue", "alpha"},
    "What of the picture: the luminance of its numbers as they are stored, decoded after that, as pbrt-v3; or one "
    "of its channels. Alpha is never decoded, and 1 where the picture has none.")};
const RegisterImageMap<RGB> imagemap_spectrum;

}  // namespace
}  // namespace whit
