#include "assets/image/png_codec.h"

#include <png.h>

#include <algorithm>
#include <cstring>

#include "assets/error.h"
#include "assets/image/image_limits.h"

namespace chiaro {
namespace {

/// libpng reports errors by a long jump, which must cross no destructor: the functions that it may leave hold only plain values,
/// and everything that owns memory lives in their callers.
struct Session {
  png_structp png = nullptr;
  png_infop info = nullptr;
  char message[200] = "";
  const std::uint8_t* data = nullptr;
  std::size_t left = 0;
  std::vector<std::uint8_t>* out = nullptr;

  explicit Session(bool reading) {
    png = reading ? png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning)
                  : png_create_write_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw std::bad_alloc();
    reading_ = reading;
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    if (reading_)
      png_destroy_read_struct(&png, &info, nullptr);
    else
      png_destroy_write_struct(&png, &info);
  }

 private:
  static void onError(png_structp png, png_const_charp text) {
    auto& session = *static_cast<Session*>(png_get_error_ptr(png));
    std::strncpy(session.message, text, sizeof session.message - 1);
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp, png_const_charp) {}

  bool reading_ = true;
};

void readBytes(png_structp png, png_bytep target, std::size_t count) {
  auto& session = *static_cast<Session*>(png_get_io_ptr(png));
  if (count > session.left) png_error(png, "the file is truncated");
  std::memcpy(target, session.data, count);
  session.data += count;
  session.left -= count;
}

bool readHeader(Session& s) {
  if (setjmp(png_jmpbuf(s.png)) != 0) return false;
  png_set_user_limits(s.png, kLargestImageSide, kLargestImageSide);
  png_set_read_fn(s.png, &s, readBytes);
  png_read_info(s.png, s.info);
  return true;
}

bool prepareRgba(Session& s) {
  if (setjmp(png_jmpbuf(s.png)) != 0) return false;
  png_set_expand(s.png);
  png_set_scale_16(s.png);
  png_set_gray_to_rgb(s.png);
  png_set_add_alpha(s.png, 255, PNG_FILLER_AFTER);
  png_set_interlace_handling(s.png);
  png_read_update_info(s.png, s.info);
  return true;
}

bool readRows(Session& s, png_bytepp rows) {
  if (setjmp(png_jmpbuf(s.png)) != 0) return false;
  png_read_image(s.png, rows);
  png_read_end(s.png, nullptr);
  return true;
}

/// Memory may run out inside a callback; an exception must not pass through libpng either.
void writeBytes(png_structp png, png_bytep data, std::size_t count) {
  auto& session = *static_cast<Session*>(png_get_io_ptr(png));
  bool ok = true;
  try {
    session.out->insert(session.out->end(), data, data + count);
  } catch (const std::exception&) {
    ok = false;
  }
  if (!ok) png_error(png, "out of memory");
}

bool writeAll(Session& s, const Image8& image, png_bytepp rows) {
  if (setjmp(png_jmpbuf(s.png)) != 0) return false;
  png_set_write_fn(s.png, &s, writeBytes, nullptr);
  png_set_IHDR(s.png, s.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_rows(s.png, s.info, rows);
  png_write_png(s.png, s.info, PNG_TRANSFORM_IDENTITY, nullptr);
  return true;
}

[[noreturn]] void fail(const Session& session, const std::string& where) {
  throw inputError(where, std::string("the PNG image cannot be decoded (") + session.message + ")", "save it again");
}

std::vector<png_bytep> rowsOf(std::uint8_t* texels, int width, int height) {
  std::vector<png_bytep> rows;
  for (int y = 0; y < height; ++y) rows.push_back(texels + 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(y));
  return rows;
}

}  // namespace

bool isPng(std::span<const std::uint8_t> bytes) {
  static constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
  return bytes.size() >= sizeof kSignature && std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin());
}

glm::ivec2 pngSize(std::span<const std::uint8_t> bytes, const std::string& where) {
  // The first chunk, whose width and height stand at byte 16, must be IHDR.
  if (bytes.size() < 24 || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0)
    throw inputError(where, "the PNG image is truncated or damaged", "save it again");
  const auto word = [&](std::size_t at) {
    return std::int64_t{bytes[at]} << 24 | std::int64_t{bytes[at + 1]} << 16 | std::int64_t{bytes[at + 2]} << 8 |
           std::int64_t{bytes[at + 3]};
  };
  requireImageSize(word(16), word(20), where);
  return {static_cast<int>(word(16)), static_cast<int>(word(20))};
}

Image8 decodePng(std::span<const std::uint8_t> bytes, const std::string& where) {
  pngSize(bytes, where);
  Session session(true);
  session.data = bytes.data();
  session.left = bytes.size();
  if (!readHeader(session) || !prepareRgba(session)) fail(session, where);
  Image8 image;
  image.width = static_cast<int>(png_get_image_width(session.png, session.info));
  image.height = static_cast<int>(png_get_image_height(session.png, session.info));
  if (png_get_rowbytes(session.png, session.info) != 4 * static_cast<std::size_t>(image.width)) fail(session, where);
  image.texels.resize(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  auto rows = rowsOf(image.texels.data(), image.width, image.height);
  if (!readRows(session, rows.data())) fail(session, where);
  return image;
}

std::vector<std::uint8_t> encodePng(const Image8& image) {
  const auto expected = 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.texels.size() != expected)
    throw Error(ExitCode::failed, "PNG", "the image's size and texels do not fit each other", "");
  std::vector<std::uint8_t> bytes;
  Session session(false);
  session.out = &bytes;
  // libpng's rows are not const, though writing only reads them.
  auto rows = rowsOf(const_cast<std::uint8_t*>(image.texels.data()), image.width, image.height);
  if (!writeAll(session, image, rows.data()))
    throw Error(ExitCode::failed, "PNG", std::string("the image cannot be encoded (") + session.message + ")", "");
  return bytes;
}

}  // namespace chiaro
