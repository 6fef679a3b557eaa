#include "assets/image/exr.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cstring>

#include "assets/error.h"
#include "assets/image/image_limits.h"

namespace chiaro {
namespace {

class MemoryInput final : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::uint8_t> bytes, const std::string& where) : Imf::IStream(where.c_str()), bytes_(bytes) {}

  bool read(char out[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_)
      throw std::runtime_error("the file is truncated");
    std::memcpy(out, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = static_cast<std::size_t>(position); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

class MemoryOutput final : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("memory") {}

  void write(const char data[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > bytes.size()) bytes.resize(end);
    std::memcpy(bytes.data() + position_, data, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = static_cast<std::size_t>(position); }

  std::vector<std::uint8_t> bytes;

 private:
  std::size_t position_ = 0;
};

/// The data and display windows of a part, checked.
struct Windows {
  Imath::Box2i data, display;

  Windows(const Imf::Header& header, const std::string& where) : data(header.dataWindow()), display(header.displayWindow()) {
    for (const auto& box : {data, display})
      requireImageSize(std::int64_t{box.max.x} - box.min.x + 1, std::int64_t{box.max.y} - box.min.y + 1, where);
  }
  int dataWidth() const { return data.max.x - data.min.x + 1; }
  int displayWidth() const { return display.max.x - display.min.x + 1; }
  int displayHeight() const { return display.max.y - display.min.y + 1; }
};

/// Copies one line of the data window into the display window.
void place(const Windows& windows, int y, const glm::vec4* line, ImageRgba& image) {
  if (y < windows.display.min.y || y > windows.display.max.y) return;
  const int first = std::max(windows.data.min.x, windows.display.min.x);
  const int last = std::min(windows.data.max.x, windows.display.max.x);
  for (int x = first; x <= last; ++x)
    image.at(x - windows.display.min.x, y - windows.display.min.y) = line[x - windows.data.min.x];
}

/// A slice over a line whose first texel is x = data.min.x; the same line serves every y.
Imf::Slice slice(glm::vec4* line, int component, const Windows& windows, double fill) {
  // OpenEXR addresses a texel as base + x * stride, also for windows that start far from 0: integer arithmetic keeps that defined.
  const auto start = reinterpret_cast<std::intptr_t>(line) + static_cast<std::intptr_t>(sizeof(float)) * component -
                     static_cast<std::intptr_t>(sizeof(glm::vec4)) * windows.data.min.x;
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(start), sizeof(glm::vec4), 0, 1, 1, fill);
}

void readColor(Imf::MultiPartInputFile& file, const Windows& windows, bool luminance, ImageRgba& image) {
  Imf::InputPart part(file, 0);
  std::vector<glm::vec4> line(static_cast<std::size_t>(windows.dataWidth()));
  Imf::FrameBuffer buffer;
  if (luminance) {
    buffer.insert("Y", slice(line.data(), 0, windows, 0.0));
  } else {
    buffer.insert("R", slice(line.data(), 0, windows, 0.0));
    buffer.insert("G", slice(line.data(), 1, windows, 0.0));
    buffer.insert("B", slice(line.data(), 2, windows, 0.0));
  }
  buffer.insert("A", slice(line.data(), 3, windows, 1.0));
  part.setFrameBuffer(buffer);
  for (int y = windows.data.min.y; y <= windows.data.max.y; ++y) {
    part.readPixels(y, y);
    if (luminance)
      for (auto& texel : line) texel = glm::vec4(texel.x, texel.x, texel.x, texel.w);
    place(windows, y, line.data(), image);
  }
}

void readLuminanceChroma(std::span<const std::uint8_t> bytes, const std::string& where, const Windows& windows,
                         ImageRgba& image) {
  MemoryInput input(bytes, where);
  Imf::RgbaInputFile file(input);
  const int width = windows.dataWidth();
  std::vector<Imf::Rgba> half(static_cast<std::size_t>(width));
  std::vector<glm::vec4> line(half.size());
  for (int y = windows.data.min.y; y <= windows.data.max.y; ++y) {
    const auto start =
        reinterpret_cast<std::intptr_t>(half.data()) - static_cast<std::intptr_t>(sizeof(Imf::Rgba)) * windows.data.min.x;
    file.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(start), 1, 0);
    file.readPixels(y, y);
    for (std::size_t x = 0; x < half.size(); ++x) line[x] = glm::vec4(half[x].r, half[x].g, half[x].b, half[x].a);
    place(windows, y, line.data(), image);
  }
}

glm::dvec3 xyzOf(Imath::V2f xy) { return {xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y}; }

/// Columns are the XYZ of each primary at the strength that makes (1,1,1) the white.
glm::dmat3 xyzFromRgb(const Imf::Chromaticities& c) {
  const glm::dmat3 primaries(xyzOf(c.red), xyzOf(c.green), xyzOf(c.blue));
  const glm::dvec3 strength = glm::inverse(primaries) * xyzOf(c.white);
  return {primaries[0] * strength.x, primaries[1] * strength.y, primaries[2] * strength.z};
}

/// Bradford chromatic adaptation (Lam 1985).
glm::dmat3 adaptation(glm::dvec3 from, glm::dvec3 to) {
  const glm::dmat3 cone = glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 ratio = (cone * to) / (cone * from);
  const glm::dmat3 scale(glm::dvec3(ratio.x, 0, 0), glm::dvec3(0, ratio.y, 0), glm::dvec3(0, 0, ratio.z));
  return glm::inverse(cone) * scale * cone;
}

void readPrimaries(const Imf::Header& header, const std::string& where, ExrImage& out) {
  if (!Imf::hasChromaticities(header)) return;
  const Imf::Chromaticities file = Imf::chromaticities(header), rec709;
  const auto distance = [](Imath::V2f a, Imath::V2f b) { return (a - b).length(); };
  if (distance(file.red, rec709.red) + distance(file.green, rec709.green) + distance(file.blue, rec709.blue) +
          distance(file.white, rec709.white) <
      1e-4f)
    return;
  const glm::dmat3 matrix =
      glm::inverse(xyzFromRgb(rec709)) * adaptation(xyzOf(file.white), xyzOf(rec709.white)) * xyzFromRgb(file);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!std::isfinite(matrix[c][r]))
        throw inputError(where, "its chromaticities make no colour space", "save the image again");
  out.rec709 = false;
  out.rec709FromFile = glm::mat3(matrix);
}

std::string channelNames(const Imf::ChannelList& channels) {
  std::string names;
  for (auto channel = channels.begin(); channel != channels.end() && names.size() < 200; ++channel)
    names += (names.empty() ? "" : ", ") + std::string(channel.name());
  return names;
}

}  // namespace

ExrImage decodeExr(std::span<const std::uint8_t> bytes, const std::string& where) {
  static constexpr std::uint8_t kMagic[] = {0x76, 0x2F, 0x31, 0x01};
  if (bytes.size() < 8 || !std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin()))
    throw inputError(where, "is not an OpenEXR image", "convert it to OpenEXR");
  try {
    // A corrupt header must not make the library allocate first and fail later.
    Imf::Header::setMaxImageSize(kLargestImageSide, kLargestImageSide);
    Imf::Header::setMaxTileSize(kLargestImageSide, kLargestImageSide);
    MemoryInput input(bytes, where);
    Imf::MultiPartInputFile file(input, 0);
    const Imf::Header& header = file.header(0);
    if (header.hasType() && !Imf::isImage(header.type())) throw inputError(where, "holds a deep image", "flatten it");
    const Windows windows(header, where);
    const Imf::ChannelList& channels = header.channels();
    const bool rgb =
        channels.findChannel("R") != nullptr && channels.findChannel("G") != nullptr && channels.findChannel("B") != nullptr;
    const bool chroma = channels.findChannel("RY") != nullptr && channels.findChannel("BY") != nullptr;
    if (!rgb && channels.findChannel("Y") == nullptr)
      throw inputError(where, "has neither R, G and B nor Y among its channels (" + channelNames(channels) + ")",
                       "save it with one of these");
    ExrImage out;
    out.image.width = windows.displayWidth();
    out.image.height = windows.displayHeight();
    out.image.texels.assign(static_cast<std::size_t>(out.image.width) * static_cast<std::size_t>(out.image.height),
                            glm::vec4(0.0f));
    if (rgb || !chroma)
      readColor(file, windows, !rgb, out.image);
    else
      readLuminanceChroma(bytes, where, windows, out.image);
    // Grey has no hue to convert.
    if (rgb || chroma) readPrimaries(header, where, out);
    return out;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& exception) {
    throw inputError(where, std::string("the OpenEXR image cannot be read (") + exception.what() + ")", "save it again");
  }
}

std::vector<std::uint8_t> encodeExr(const ImageRgba& image) {
  const auto expected = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.texels.size() != expected)
    throw Error(ExitCode::failed, "OpenEXR", "the image's size and texels do not fit each other", "");
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  const char* const names[] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    // OpenEXR's slices serve reading and writing, hence the cast; writing does not change them.
    auto* base =
        const_cast<char*>(reinterpret_cast<const char*>(image.texels.data())) + sizeof(float) * static_cast<std::size_t>(c);
    buffer.insert(names[c],
                  Imf::Slice(Imf::FLOAT, base, sizeof(glm::vec4), sizeof(glm::vec4) * static_cast<std::size_t>(image.width)));
  }
  MemoryOutput output;
  {
    Imf::OutputFile file(output, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  }
  return std::move(output.bytes);
}

}  // namespace chiaro
