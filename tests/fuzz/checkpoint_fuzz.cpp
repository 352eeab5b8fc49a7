// libFuzzer entry: any bytes between the first word of a checkpoint and a checksum that is right are what a render goes on
// from, or a part of a picture. They are refused, or are the state of a film, of which a picture can be made. As everybody's checksum is right here,
// what the state says is not trusted to be of a film that there was.
#include <algorithm>
#include <cstring>
#include <vector>

#include "core/image/checksum.h"
#include "core/render/film_render.h"
#include "core/session/checkpoint.h"
#include "core/session/parts.h"
#include "tests/fuzz/shared/fuzz.h"

namespace {

using whit::fuzz::require;

struct World {
  whit::ParsedFile file =
      whit::read_scene_text("fuzz",
                            "Film \"image\" \"integer xresolution\" [8] \"integer yresolution\" [8] Sampler \"sobol\" "
                            "\"integer pixelsamples\" 4\n"
                            "WorldBegin LightSource \"infinite\" Translate 0 0 5 Shape \"sphere\" WorldEnd\n");
  whit::BuiltWorld built = whit::build_world(whit::plan_world(file.worlds.at(0), *file.sources));
};

const World& world() {
  static const World one;
  return one;
}

whit::RenderOptions options() {
  whit::RenderOptions out;
  out.threads = 1, out.adaptive = true, out.blocks = true;
  out.aovs.names = {"albedo", "P", "shape", "samples", "variance"};
  out.aovs.place = [](whit::SourcePos) { return std::string("here"); };
  return out;
}

std::string framed(const uint8_t* data, size_t size) {
  std::string bytes = "whit checkpoint\n" + whit::fuzz::text_of(data, size);
  const uint64_t sum = whit::checksum(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

/// What stands between them for a film that was rendered.
const std::string& true_state() {
  static const std::string state = [] {
    whit::FilmRender film(*world().built.scene, options());
    require(film.extend(4));
    std::string bytes;
    whit::ByteWriter out([&](const void* from, size_t n) { bytes.append(static_cast<const char*>(from), n); });
    whit::CheckpointHead head;
    head.command = {"/", "scene.pbrt", {"--spp", "4"}}, head.part = film.part();
    head.save(out);
    film.save(out);
    return bytes.substr(std::string_view("whit checkpoint\n").size());
  }();
  return state;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static whit::fuzz::MemoryFile file;
  const std::string bytes = framed(data, size);
  file.set(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  whit::Checkpoint checkpoint("/dev/null/nowhere", whit::Checkpoint::Seconds(0), {}, {});
  if (checkpoint.resume(file.path()).trouble != whit::Checkpoint::Trouble::None) return 0;
  whit::FilmRender film(*world().built.scene, options());
  if (checkpoint.begin(film)) require(film.result().picture.rgb.size() == 3 * 8 * 8);
  whit::plan_parts({file.path(), file.path()});
  const whit::CheckpointFile kept(file.path());
  whit::ByteReader in(kept.state);
  whit::FilmRender joined(*world().built.scene, options());
  if (joined.merge(in)) require(joined.result().picture.rgb.size() == 3 * 8 * 8);
  // As what came of a share, and as a pass.
  whit::ByteReader part(kept.state), pass(kept.state);
  whit::FilmRender shared(*world().built.scene, options()), share(*world().built.scene, options());
  shared.begin_pass(std::vector<uint32_t>(shared.units().size(), 4));
  if (shared.add_share(part)) require(shared.result().picture.rgb.size() == 3 * 8 * 8);
  if (share.take_share(pass, 0, 1)) require(share.rest().tiles > 0 || share.rest().samples == 0);
  return 0;
}

/// A film's state that chance would never find, damaged somewhere.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  whit::fuzz::Dice dice(seed);
  const std::string& state = true_state();
  if (size < state.size() / 2 && state.size() <= max_size) {
    std::memcpy(data, state.data(), state.size());
    size = state.size();
  }
  if (size < 8 || dice.one_in(3)) return LLVMFuzzerMutate(data, size, max_size);
  // A number in the place of another.
  const uint64_t odd[] = {0, 1, 4, 255, UINT32_MAX, UINT64_MAX, uint64_t{1} << 63, uint64_t{0x7ff0} << 48};
  const size_t width = dice.one_in(2) ? 4 : 8, at = dice.below(size - width + 1);
  const uint64_t number = dice.one_of(odd);
  std::memcpy(data + at, &number, width);
  return size;
}
