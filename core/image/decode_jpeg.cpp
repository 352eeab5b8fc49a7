// JPEG files by libjpeg-turbo, with the settings that OpenImageIO has.
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

// These two want <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

#include "core/image/decode.h"
#include "core/image/oiio/module.h"

namespace whit {
namespace {

uint32_t word(std::string_view bytes, size_t at) {
  if (at + 4 > bytes.size()) return 0;
  const auto byte = [&](size_t i) { return uint32_t{static_cast<uint8_t>(bytes[at + i])}; };
  return byte(0) << 24 | byte(1) << 16 | byte(2) << 8 | byte(3);
}

// The name of a colour profile; "" when it has none. Source: ICC.1:2001-04 and ICC.1:2010, the tag "desc".
std::string profile_name(std::string_view icc) {
  const auto part = [&](size_t at, size_t n) { return at < icc.size() ? icc.substr(at, n) : std::string_view(); };
  const size_t tags = std::min<size_t>(word(icc, 128), 1000);
  for (size_t i = 0; i < tags; ++i) {
    if (part(132 + 12 * i, 4) != "desc") continue;
    const size_t at = word(icc, 136 + 12 * i);
    if (part(at, 4) == "desc") {
      const std::string_view text = part(at + 12, word(icc, at + 8));
      return std::string(text.substr(0, text.find('\0')));
    }
    // UTF-16 in several languages; what is beyond ASCII does not matter for what is looked for.
    std::string name;
    for (const char c : part(at + word(icc, at + 24), word(icc, at + 20)))
      if (c != '\0') name += c;
    return name;
  }
  return "";
}

class JpegRows : public PictureRows {
 public:
  explicit JpegRows(const PictureFile& file) : file_(open_to_read(file)) {
    jpeg_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = [](j_common_ptr jpeg) { give_up(jpeg); };
    errors_.base.emit_message = [](j_common_ptr jpeg, int level) {
      // Without the rest the library would make up pixels.
      if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF) give_up(jpeg);
    };
    try {
      run([this] { jpeg_create_decompress(&jpeg_); });
      run([this] {
        jpeg_stdio_src(&jpeg_, file_.get());
        jpeg_save_markers(&jpeg_, JPEG_APP0 + 2, 0xffff);  // the colour profile
        jpeg_read_header(&jpeg_, TRUE);
      });
      set_info();
      if (std::string problem = size_problem(file, info); !problem.empty()) throw std::runtime_error(problem);
    } catch (...) {
      jpeg_destroy_decompress(&jpeg_);
      throw;
    }
  }
  ~JpegRows() override { jpeg_destroy_decompress(&jpeg_); }

  /// Whether it is grey or has three colours. Others, for print, want a conversion that the library does not have.
  bool is_common() const { return jpeg_.num_components == 1 || jpeg_.num_components == 3; }

  const uint8_t* next_bytes() override {
    if (row_.empty()) {
      row_.resize(static_cast<size_t>(info.width) * info.channels);
      run([this] { jpeg_start_decompress(&jpeg_); });
    }
    run([this] {
      JSAMPROW row = row_.data();
      jpeg_read_scanlines(&jpeg_, &row, 1);
    });
    return row_.data();
  }

  const float* next_floats() override { throw std::logic_error("the picture has bytes"); }

  size_t memory() const override {
    // Progressive files have all of their coefficients in memory, two bytes each.
    const size_t row = static_cast<size_t>(info.width) * info.channels;
    return row * (jpeg_has_multiple_scans(const_cast<j_decompress_ptr>(&jpeg_)) ? 2 * info.height + 64 : 64);
  }

 private:
  struct Errors {
    jpeg_error_mgr base;
    std::jmp_buf back;
  };

  [[noreturn]] static void give_up(j_common_ptr jpeg) { std::longjmp(reinterpret_cast<Errors*>(jpeg->err)->back, 1); }

  // Calls the library, whose errors jump out of it. Nothing on the way has a destructor.
  template <class Call>
  void run(const Call& call) {
    if (setjmp(errors_.back) == 0) return call();
    char text[JMSG_LENGTH_MAX];
    errors_.base.format_message(reinterpret_cast<j_common_ptr>(&jpeg_), text);
    throw std::runtime_error(text);
  }

  void set_info() {
    const bool grey = jpeg_.num_components == 1;
    set_header(info, static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height), SampleFormat::UInt8,
               grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"});
    JOCTET* profile = nullptr;
    unsigned length = 0;
    run([&] { jpeg_read_icc_profile(&jpeg_, &profile, &length); });
    if (!profile) return;
    const std::unique_ptr<JOCTET, void (*)(void*)> bytes(profile, std::free);
    info.metadata["ICCProfile:profile_description"] = profile_name({reinterpret_cast<const char*>(profile), length});
  }

  FilePtr file_;
  jpeg_decompress_struct jpeg_{};
  Errors errors_{};
  std::vector<uint8_t> row_;
};

}  // namespace

std::unique_ptr<PictureRows> open_jpeg(const PictureFile& file) {
  auto rows = std::make_unique<JpegRows>(file);
  if (!rows->is_common()) return oiio().open(file);
  return rows;
}

}  // namespace whit
