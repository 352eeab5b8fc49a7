// OpenEXR files with all their parts, read by OpenEXR itself on all cores.
#include "core/image/read_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <thread>

#include "core/base/plain_text.h"
#include "core/image/decode.h"
#include "core/image/exr_header.h"
#include "core/plugin/memory_limit.h"

namespace whit {
namespace {

// Whole numbers up to here are floats too.
constexpr float kWholeFloats = 16777216;

void add_metadata(const Imf::Header& header, ImageInfo& info) {
  for (auto i = header.begin(); i != header.end(); ++i) {
    const Imf::Attribute& value = i.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&value)) info.metadata[i.name()] = text->value();
    if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&value))
      info.metadata[i.name()] = std::to_string(whole->value());
    if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&value))
      info.metadata[i.name()] = fmt::format("{}", real->value());
    if (const auto* primaries = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&value)) {
      const Imf::Chromaticities& c = primaries->value();
      info.metadata[i.name()] = fmt::format("{} {} {} {} {} {} {} {}", c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x,
                                            c.blue.y, c.white.x, c.white.y);
    }
  }
}

void set_windows(const Imf::Header& header, ImageInfo& info) {
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  info.x = data.min.x;
  info.y = data.min.y;
  info.width = data.max.x - data.min.x + 1;
  info.height = data.max.y - data.min.y + 1;
  info.full_x = display.min.x;
  info.full_y = display.min.y;
  info.full_width = display.max.x - display.min.x + 1;
  info.full_height = display.max.y - display.min.y + 1;
}

// Where a channel comes from.
struct Source {
  int part;
  std::string name;
  Imf::PixelType type;
};

std::string part_name(const Imf::MultiPartInputFile& file, int part) {
  const Imf::Header& header = file.header(part);
  return header.hasName() ? header.name() : fmt::format("part{}", part);
}

void check_part(const Imf::MultiPartInputFile& file, int part) {
  const Imf::Header& header = file.header(part);
  if (header.hasType() && Imf::isDeepData(header.type())) throw std::runtime_error("deep pictures are not supported");
  if (header.dataWindow() != file.header(0).dataWindow() || header.displayWindow() != file.header(0).displayWindow())
    throw std::runtime_error(
        fmt::format("its parts have different windows: \"{}\" and \"{}\"", part_name(file, 0), part_name(file, part)));
  const Imf::ChannelList& channels = header.channels();
  for (auto c = channels.begin(); c != channels.end(); ++c)
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      throw std::runtime_error(fmt::format("channel {} has not a number for every pixel", c.name()));
}

SampleFormat format_of(Imf::PixelType type) { return type == Imf::HALF ? SampleFormat::Half : SampleFormat::Float; }

// The part that holds the picture itself, by its name, or -1. Parts may be in any order.
int main_part(const Imf::MultiPartInputFile& file) {
  for (const char* name : {"rgba", "rgb", "beauty", "main", "combined", "c"}) {
    int found = -1;
    for (int part = 0; part < file.parts(); ++part)
      if (lower_case(part_name(file, part)) == name &&
          (found < 0 || part_name(file, part) < part_name(file, found)))  // "RGBA" and "rgba" are two names
        found = part;
    if (found >= 0) return found;
  }
  return -1;
}

// In how many parts there is a channel of that name.
std::map<std::string, int> count_names(const Imf::MultiPartInputFile& file) {
  std::map<std::string, int> counts;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::ChannelList& channels = file.header(part).channels();
    for (auto c = channels.begin(); c != channels.end(); ++c) ++counts[c.name()];
  }
  return counts;
}

// The names of all channels, whatever the order of the parts.
std::vector<Source> add_channels(const Imf::MultiPartInputFile& file, PicturePlanes& picture) {
  std::vector<Source> sources;
  const std::map<std::string, int> counts = count_names(file);
  const int main = main_part(file);
  for (int part = 0; part < file.parts(); ++part) {
    check_part(file, part);
    const Imf::ChannelList& channels = file.header(part).channels();
    const std::string prefix = part_name(file, part) + ".";
    for (auto c = channels.begin(); c != channels.end(); ++c) {
      const std::string name = c.name();
      sources.push_back({part, name, c.channel().type});
      picture.formats.push_back(format_of(c.channel().type));
      picture.channel_names.push_back(part == main || counts.at(name) == 1 ? name : prefix + name);
    }
  }
  picture.channels = static_cast<int>(sources.size());
  return sources;
}

void check_names(const PicturePlanes& picture) {
  std::vector<std::string> names = picture.channel_names;
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) throw std::runtime_error(fmt::format("it has two channels {}", *twice));
}

void read_part(Imf::MultiPartInputFile& file, int part, const std::vector<Source>& sources, PicturePlanes& picture) {
  Imf::FrameBuffer buffer;
  const Imath::V2i origin(picture.x, picture.y);
  for (size_t c = 0; c < sources.size(); ++c)
    if (sources[c].part == part)
      buffer.insert(sources[c].name,
                    Imf::Slice::Make(Imf::FLOAT, picture.planes[c].data(), origin, picture.width, picture.height));
  Imf::InputPart input(file, part);
  input.setFrameBuffer(buffer);
  input.readPixels(picture.y, picture.y + picture.height - 1);
}

// A float that came of a whole number beyond may be its neighbour's too.
void check_whole_numbers(const std::vector<Source>& sources, const PicturePlanes& picture) {
  for (size_t c = 0; c < sources.size(); ++c) {
    const std::vector<float>& plane = picture.planes[c];
    if (sources[c].type == Imf::UINT &&
        std::any_of(plane.begin(), plane.end(), [](float v) { return v >= kWholeFloats; }))
      throw std::runtime_error(fmt::format("channel {} has whole numbers from {} on, more than a float tells apart",
                                           picture.channel_names[c], kWholeFloats));
  }
}

}  // namespace

PicturePlanes read_exr_planes(const std::string& path) {
  if (const std::string problem = exr_header_problem(path); !problem.empty()) throw std::runtime_error(problem);
  // Decompressing is most of it; Imf's own pool starts with no threads.
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  Imf::MultiPartInputFile file(path.c_str());
  PicturePlanes picture;
  set_windows(file.header(0), picture);
  for (int part = file.parts(); part-- > 0;) add_metadata(file.header(part), picture);
  if (const int main = main_part(file); main >= 0) add_metadata(file.header(main), picture);
  const std::vector<Source> sources = add_channels(file, picture);
  check_names(picture);
  if (sources.empty()) throw std::runtime_error("it has no channels");
  picture.format = *std::max_element(picture.formats.begin(), picture.formats.end());
  if (std::string problem = size_problem(path, picture); !problem.empty()) throw std::runtime_error(problem);
  need_memory(sizeof(float) * sources.size() * static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height),
              fmt::format("reading {} channels of its {} x {} pixels", sources.size(), picture.width, picture.height));
  picture.planes.assign(sources.size(), std::vector<float>(static_cast<size_t>(picture.width) * picture.height));
  for (int part = 0; part < file.parts(); ++part) read_part(file, part, sources, picture);
  check_whole_numbers(sources, picture);
  return picture;
}

}  // namespace whit
