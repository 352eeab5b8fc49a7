// Colours given as spectra: turned into linear Rec.709 once, when a scene is read.
//
// The conversions are pbrt-v3's for its RGB build (PBR book, 3rd ed., 5.2), because pictures are compared
// with it. Illuminants and reflectances are converted alike.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/vec.h"

namespace whit {

/// Linear Rec.709 of CIE XYZ (D65 white, Y = 1 gives luminance 1). May be negative outside the gamut.
RGB rgb_from_xyz(double x, double y, double z);

/// The colour of spectral samples: `pairs` holds wavelength (nm, any order) and value in turn, at least one
/// pair. Linear between samples, constant beyond the first and last. A spectrum of 1 everywhere has luminance
/// 0.998 (470/471), as in pbrt-v3. Of samples at the same wavelength the later ones hold from there on.
RGB rgb_from_samples(std::span<const double> pairs);

/// Planck's law at temperature `kelvin` > 0, scaled so that its largest value over all wavelengths is
/// `scale`.
RGB rgb_from_blackbody(double kelvin, double scale);

/// Spectral radiance of a blackbody in W / (m^2 sr m) at a wavelength in nm. Planck 1900.
double planck(double nm, double kelvin);

/// The contents of an .spd file, or why there are none.
struct SpdFile {
  std::vector<double> pairs;  ///< Wavelength in nm and value in turn.
  std::string error;          ///< "" on success; else "line 3: expected a number", or why it cannot be read.
  bool readable = true;       ///< False when the file could not be read at all.
};

/// Reads wavelength-value pairs: numbers separated by white space, # to the end of the line is a comment.
SpdFile read_spd_file(const std::string& path);

}  // namespace whit
