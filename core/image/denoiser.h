// OpenImageDenoise, loaded when somebody asks for it: whit is built and runs without.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace whit {

struct DenoiserResult;

/// What takes the noise out of a picture, and some of the picture with it: what it makes is biased. Any number of threads
/// may use it at once.
class Denoiser {
 public:
  ~Denoiser();

  /// A picture of linear colour, and what its first surfaces are. All have width x height x 3 numbers, row by row.
  struct Input {
    int width = 0, height = 0;
    std::span<const float> rgb;
    std::span<const float> albedo;  ///< In [0, 1].
    std::span<const float> normal;  ///< Unit vectors, or 0 where there is none.
    int threads = 0;                ///< 0: as many as it likes.
  };
  struct Output {
    std::vector<float> rgb;  ///< As Input::rgb.
    std::string error;       ///< "" when there is a picture.
  };
  Output denoise(const Input& input) const;

  /// Bytes that the library may take beside the input and the output, for so many pixels: it is told so, and works tile by
  /// tile where that is less than it likes.
  static size_t memory(double pixels);

  /// "OpenImageDenoise 1.4.3"
  std::string describe() const;
  /// The library's file.
  const std::string& path() const { return path_; }

 private:
  friend DenoiserResult load_denoiser();
  struct Functions;
  Denoiser(std::unique_ptr<const Functions> functions, std::string path);
  std::unique_ptr<const Functions> functions_;
  std::string path_;
};

/// The denoiser, or the text that says why there is none and what to do about it.
struct DenoiserResult {
  std::unique_ptr<const Denoiser> denoiser;
  std::string error;
};

/// Loads the library, of version 1.4 or newer: the file or folder that the environment's WHIT_OIDN names, and nothing else
/// where it names one; else the loader's libOpenImageDenoise.so.2 or .1; else that of Python's package oidn, in the
/// environment that is active ($VIRTUAL_ENV), the one that the program lies in, the user's or the system's.
DenoiserResult load_denoiser();

}  // namespace whit
