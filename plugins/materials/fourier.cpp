// A measured or simulated BSDF from a file: a cosine series in the azimuth for every pair of zenith angles. Jakob et
// al., A Comprehensive Framework for Rendering Layered Materials, 2014; see core/lobe/fourier.h. Isotropic, of
// one or three channels.
#include "core/lobe/fourier.h"

#include <string>

#include "core/base/limits.h"
#include "core/base/mapped_file.h"
#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Fourier : Material, NeedsMemory {
  FileName bsdffile;
  FourierTable table;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (bsdffile.empty())
      diagnostics.error(statement, "fourier needs a \"bsdffile\"", "name a .bsdf file of layerlab's");
  }

  bool read(Diagnostics& diagnostics, SourcePos) override {
    if (bsdffile.empty()) return true;  // reported by check()
    const MappedFile file(bsdffile.path);
    std::string problem = file.error();
    if (problem.empty() && file.bytes().size() > kBsdfBytes.most) problem = more_bytes_than(kBsdfBytes);
    if (problem.empty()) {
      const std::string wrong = parse_fourier_table(file.bytes(), table);
      problem = file.problem();
      if (problem.empty() && wrong.empty()) return true;
      if (problem.empty()) {
        diagnostics.file_error(bsdffile.where, '"' + bsdffile.as_given + "\" " + wrong);
        return false;
      }
    }
    diagnostics.file_error(bsdffile.where, "cannot read \"" + bsdffile.as_given + "\": " + problem);
    return false;
  }

  /// The numbers are kept as they are in the file, which is in memory beside them while they are read.
  MemoryNeed memory_need(const MeshAttributes&) const override {
    if (bsdffile.empty()) return {};
    const MappedFile file(bsdffile.path);
    const uint64_t bytes = file.bytes().size();
    return bytes > kBsdfBytes.most ? MemoryNeed() : MemoryNeed{.table = bytes, .making = bytes};
  }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (s.n > 0 && table.max_order == 0) return;  // nothing in the file, or none read
    Lobe lobe;
    lobe.type = LobeType::Fourier;
    float* const one = filled(s, 1);
    lobe.weight = {one, one, one};
    lobe.table = &table;
    out.add(lobe);
  }
};

const Register<Fourier> fourier{
    "fourier", "A tabulated BSDF from a file.",
    param(&Fourier::bsdffile, "bsdffile", Unit::None,
          "The file, in layerlab's format: \"SCATFUN\", version 1, of up to 1 GiB. Required."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
