#include "assets/image/radiance_hdr.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "assets/error.h"
#include "assets/image/image_limits.h"

namespace chiaro {
namespace {

using Rgbe = glm::u8vec4;

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  ImageRgb decode() {
    readHeader();
    readResolution();
    ImageRgb image;
    image.width = width_;
    image.height = height_;
    image.texels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    std::vector<Rgbe> row(static_cast<std::size_t>(width_));
    for (int y = 0; y < height_; ++y) {
      readRow(row);
      for (int x = 0; x < width_; ++x)
        image.at(rightToLeft_ ? width_ - 1 - x : x, bottomUp_ ? height_ - 1 - y : y) = radiance(row[static_cast<std::size_t>(x)]);
    }
    return image;
  }

 private:
  Error fail(const std::string& problem) const { return inputError(where_, problem, "save the image again"); }

  std::string line() {
    std::string text;
    for (;;) {
      if (offset_ >= bytes_.size()) throw fail("the Radiance header is truncated");
      const char c = static_cast<char>(bytes_[offset_++]);
      if (c == '\n') return text;
      if (c != '\r') text += c;
    }
  }

  void readHeader() {
    const std::string magic = line();
    if (magic.rfind("#?", 0) != 0) throw fail("is not a Radiance HDR image (it does not start with \"#?\")");
    for (std::string text = line(); !text.empty(); text = line()) {
      if (text.rfind("FORMAT=", 0) == 0 && text != "FORMAT=32-bit_rle_rgbe")
        throw fail("has the unsupported format \"" + text.substr(7) + "\"");
      if (text.rfind("EXPOSURE=", 0) == 0) {
        const double exposure = std::strtod(text.c_str() + 9, nullptr);
        if (!(exposure > 0.0) || !std::isfinite(exposure)) throw fail("has a malformed line \"" + text + "\"");
        scale_ /= exposure;
      }
    }
  }

  void readResolution() {
    const std::string text = line();
    std::istringstream words(text);
    std::string yAxis, xAxis;
    std::int64_t height = 0, width = 0;
    words >> yAxis >> height >> xAxis >> width;
    const bool ok = !words.fail() && (yAxis == "-Y" || yAxis == "+Y") && (xAxis == "+X" || xAxis == "-X");
    if (!ok) throw fail("has the unsupported resolution line \"" + text + "\"");
    requireImageSize(width, height, where_);
    // The shortest scanline is a run-length coded one: 4 bytes, or one old run per 255 texels.
    if (static_cast<std::size_t>(height) > (bytes_.size() - offset_)) throw fail("the image is truncated");
    width_ = static_cast<int>(width);
    height_ = static_cast<int>(height);
    bottomUp_ = yAxis == "+Y";
    rightToLeft_ = xAxis == "-X";
  }

  std::uint8_t byte() {
    if (offset_ >= bytes_.size()) throw fail("the image is truncated");
    return bytes_[offset_++];
  }

  Rgbe texel() {
    Rgbe value;
    for (int c = 0; c < 4; ++c) value[c] = byte();
    return value;
  }

  void readRow(std::vector<Rgbe>& row) {
    if (width_ >= 8 && width_ < 32768 && bytes_.size() - offset_ >= 4 && bytes_[offset_] == 2 && bytes_[offset_ + 1] == 2 &&
        bytes_[offset_ + 2] < 128) {
      if (bytes_[offset_ + 2] * 256 + bytes_[offset_ + 3] != width_) throw fail("a scanline has the wrong length");
      offset_ += 4;
      for (int c = 0; c < 4; ++c) readComponent(row, c);
    } else {
      readOldRow(row);
    }
  }

  void readComponent(std::vector<Rgbe>& row, int c) {
    std::size_t x = 0;
    while (x < row.size()) {
      std::size_t count = byte();
      const bool run = count > 128;
      if (run) count -= 128;
      if (count == 0 || count > row.size() - x) throw fail("a run does not fit into its scanline");
      std::uint8_t value = run ? byte() : std::uint8_t{0};
      for (std::size_t i = 0; i < count; ++i) {
        if (!run) value = byte();
        row[x++][c] = value;
      }
    }
  }

  void readOldRow(std::vector<Rgbe>& row) {
    std::size_t x = 0;
    int shift = 0;
    while (x < row.size()) {
      const Rgbe value = texel();
      if (value.x == 1 && value.y == 1 && value.z == 1) {
        // Consecutive runs are the digits, base 256, of one long run of the texel before.
        if (shift > 16) throw fail("a run does not fit into its scanline");
        const std::size_t count = static_cast<std::size_t>(value.w) << shift;
        if (x == 0 || count > row.size() - x) throw fail("a run does not fit into its scanline");
        for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
        shift += 8;
      } else {
        row[x++] = value;
        shift = 0;
      }
    }
  }

  glm::vec3 radiance(Rgbe value) const {
    if (value.w == 0) return glm::vec3(0.0f);
    const double scale = std::ldexp(scale_, value.w - 136);
    const glm::vec3 out(glm::dvec3(value.x, value.y, value.z) * scale);
    if (!std::isfinite(out.x) || !std::isfinite(out.y) || !std::isfinite(out.z)) throw fail("a texel is not finite");
    return out;
  }

  std::span<const std::uint8_t> bytes_;
  const std::string& where_;
  std::size_t offset_ = 0;
  double scale_ = 1.0;
  int width_ = 0, height_ = 0;
  bool bottomUp_ = false, rightToLeft_ = false;
};

}  // namespace

ImageRgb decodeRadianceHdr(std::span<const std::uint8_t> bytes, const std::string& where) {
  return Decoder(bytes, where).decode();
}

}  // namespace chiaro
