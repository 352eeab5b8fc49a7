// Bytes inside a page: as text, and pictures as addresses that hold them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/image/encode.h"

namespace whit {

/// The text of bytes: RFC 4648, section 4, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// "data:" addresses of a picture: without loss, and small.
std::string png_address(const DisplayPixels& pixels);
std::string jpeg_address(const DisplayPixels& pixels, int quality);

/// The bytes deflated, as RFC 1950 has it ("zlib"), which browsers inflate.
std::vector<unsigned char> deflated(std::span<const unsigned char> bytes);

}  // namespace whit
