// JPEG files in memory, by libjpeg-turbo. Colours keep all their pixels (4:4:4).
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

// These two want <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

#include "core/image/encode.h"

namespace whit {
namespace {

// The library ends the program at errors unless it is kept from returning.
struct Errors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  char reason[JMSG_LENGTH_MAX];
};

void give_up(j_common_ptr jpeg) {
  auto* errors = reinterpret_cast<Errors*>(jpeg->err);
  jpeg->err->format_message(jpeg, errors->reason);
  std::longjmp(errors->back, 1);
}

// What is made outside, so that nothing with a destructor is jumped over.
struct Encoder {
  jpeg_compress_struct jpeg{};
  Errors errors{};
  unsigned char* bytes = nullptr;
  unsigned long length = 0;

  ~Encoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }

  bool run(const DisplayPixels& pixels, int quality) {
    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = give_up;
    if (setjmp(errors.back)) return false;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &length);
    jpeg.image_width = static_cast<JDIMENSION>(pixels.width);
    jpeg.image_height = static_cast<JDIMENSION>(pixels.height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    for (size_t y = 0; y < jpeg.image_height; ++y) {
      auto* row = const_cast<JSAMPROW>(&pixels.bytes[y * 3 * jpeg.image_width]);
      jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
  }
};

}  // namespace

std::vector<unsigned char> encode_jpeg(const DisplayPixels& pixels, int quality) {
  Encoder encoder;
  if (!encoder.run(pixels, quality)) throw std::runtime_error(encoder.errors.reason);
  return {encoder.bytes, encoder.bytes + encoder.length};
}

}  // namespace whit
