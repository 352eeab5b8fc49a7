// What the steps of building a scene have in common: they read the scene as far as it is built, prepare plugins, and
// report.
#pragma once

#include <tbb/parallel_for.h>

#include <vector>

#include "core/scene/scene.h"

namespace whit {

struct BuildContext {
  const Scene& scene;  ///< As far as it is built; a step that builds on is handed what it changes.
  TextureStore& textures;
  Diagnostics& diagnostics;
  KeptGeometry* kept = nullptr;         ///< BuildOptions::kept
  bool robust = true;                   ///< BuildOptions::robust_traversal
  std::vector<int> placed = {};         ///< How often each object is placed, where geometry is kept.
  double scene_radius = 1;              ///< In render space, from when that is chosen.
  Elapsed* reading_pictures = nullptr;  ///< PrepareContext::reading_pictures, while lights are prepared.

  const SceneDescription& description() const { return *scene.bound.description; }
  const ShapeDescription& shape(size_t i) const { return description().shapes[i]; }

  /// A transform of the description as the plan has it move: without motion blur it stands as it does when the shutter
  /// opens.
  TransformPair transform(int i) const;

  PrepareContext preparation(SourcePos where, Diagnostics& reports) const;

  /// Reads and prepares a plugin, which is dropped when that fails.
  template <class T>
  void prepare(Bound<T>& bound, Diagnostics& reports) const {
    bound.plugin = after_reading(std::move(bound.plugin), reports, bound.where);
    bound.plugin = prepared(std::move(bound.plugin), preparation(bound.where, reports));
  }
  template <class T>
  void prepare(Bound<T>& bound) const {
    prepare(bound, diagnostics);
  }

  /// Calls f(i, reports) for each i below n, on all threads; what they report is kept in order.
  template <class F>
  void for_each(size_t n, const F& f) const {
    std::vector<Diagnostics> reports(n);
    tbb::parallel_for(size_t{0}, n, [&](size_t i) { f(i, reports[i]); });
    for (const Diagnostics& report : reports) diagnostics.append(report);
  }
};

}  // namespace whit
