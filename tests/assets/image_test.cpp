// Pictures in and out: every OpenEXR flavour, Radiance run lengths, PNG and JPEG, and what happens to damaged ones.
#include "assets/image/image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <png.h>

#include <cmath>

#include "assets/image/radiance_hdr.h"
#include "tests/assets/asset_test_support.h"

namespace chiaro {
namespace {

using test::errorOf;
using test::Folder;
using testing::HasSubstr;

/// Smooth, so that lossy compressions have little to lose; up to 6 in one channel.
float radianceAt(int x, int y, int channel) {
  const float phase = 0.13f * static_cast<float>(x) + 0.07f * static_cast<float>(y) + static_cast<float>(channel);
  return (1.0f + std::sin(phase)) * (channel == 2 ? 3.0f : 0.5f) + 0.01f;
}

/// Writes channels of one type over a data window. The library reads what this, and not its own writer, makes.
struct ExrWriter {
  Imath::Box2i display{{0, 0}, {36, 20}};
  Imath::Box2i data{{0, 0}, {36, 20}};
  Imf::PixelType type = Imf::HALF;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  std::vector<std::string> channels{"R", "G", "B"};
  bool tiled = false;
  std::optional<Imf::Chromaticities> chromaticities;

  void write(const std::filesystem::path& path) const {
    Imf::Header header(display, data);
    header.compression() = compression;
    if (chromaticities) Imf::addChromaticities(header, *chromaticities);
    const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
    const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<std::vector<char>> storage;
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      header.channels().insert(channels[c], Imf::Channel(type));
      const std::size_t size = type == Imf::HALF ? 2 : 4;
      storage.emplace_back(texels * size);
      char* out = storage.back().data();
      for (int y = data.min.y; y <= data.max.y; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x, out += size) {
          const float value = radianceAt(x, y, static_cast<int>(c));
          const Imath::half narrow(value);
          const auto whole = static_cast<unsigned int>(100.0f * value);
          std::memcpy(out,
                      type == Imf::HALF    ? static_cast<const void*>(&narrow)
                      : type == Imf::FLOAT ? static_cast<const void*>(&value)
                                           : &whole,
                      size);
        }
      char* base = storage.back().data() -
                   (static_cast<std::ptrdiff_t>(data.min.y) * width + data.min.x) * static_cast<std::ptrdiff_t>(size);
      buffer.insert(channels[c], Imf::Slice(type, base, size, size * static_cast<std::size_t>(width)));
    }
    if (tiled) {
      header.setTileDescription(Imf::TileDescription(16, 8, Imf::MIPMAP_LEVELS));
      Imf::TiledOutputFile file(path.string().c_str(), header);
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
    } else {
      Imf::OutputFile file(path.string().c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(height);
    }
  }
};

double worst(const ImageRgb& image, double scale = 1.0) {
  double error = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        error =
            std::max(error, std::abs(static_cast<double>(image.at(x, y)[c]) / scale - static_cast<double>(radianceAt(x, y, c))));
  return error;
}

TEST(Exr, EveryCompressionOfEveryType) {
  const Folder folder;
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT})
      for (const bool tiled : {false, true}) {
        SCOPED_TRACE(std::to_string(compression) + " type " + std::to_string(type) + (tiled ? " tiled" : ""));
        ExrWriter writer;
        writer.compression = static_cast<Imf::Compression>(compression);
        writer.type = type;
        writer.tiled = tiled;
        writer.write(folder / "a.exr");
        const ImageRgb image = readHdrImage(folder / "a.exr");
        ASSERT_EQ(image.width, 37);
        ASSERT_EQ(image.height, 21);
        const bool lossy = compression >= Imf::PXR24_COMPRESSION;
        // Half: 11 bits of 6 are 2^-9. Uint was cut to hundredths. The lossy ones (B44, DWA at its default level 45) stay within 3 %
        // of 6 on a smooth picture; PXR24 keeps 15 bits of a float.
        const double tolerance = lossy ? 0.18 : type == Imf::FLOAT ? 0.0 : type == Imf::HALF ? 1.0 / 256 : 0.0101;
        EXPECT_LE(worst(image, type == Imf::UINT ? 100.0 : 1.0), tolerance);
      }
}

TEST(Exr, DataWindowInsideAndAcrossTheDisplayWindow) {
  const Folder folder;
  ExrWriter writer;
  writer.type = Imf::FLOAT;
  writer.display = {{-3, 5}, {16, 24}};
  writer.data = {{-10, 8}, {4, 40}};
  writer.write(folder / "a.exr");
  const ImageRgb image = readHdrImage(folder / "a.exr");
  ASSERT_EQ(image.width, 20);
  ASSERT_EQ(image.height, 20);
  EXPECT_EQ(image.at(0, 0), glm::vec3(0.0f)) << "above the data";
  EXPECT_EQ(image.at(19, 10), glm::vec3(0.0f)) << "right of the data";
  EXPECT_EQ(image.at(0, 3).x, radianceAt(-3, 8, 0));
  EXPECT_EQ(image.at(7, 19).z, radianceAt(4, 24, 2));
}

TEST(Exr, LuminanceOnlyAndAlpha) {
  const Folder folder;
  ExrWriter writer;
  writer.type = Imf::FLOAT;
  writer.channels = {"Y", "A"};
  writer.write(folder / "a.exr");
  const ImageRgba image = readExr(folder / "a.exr");
  const float y = radianceAt(3, 4, 0);
  EXPECT_EQ(image.at(3, 4), glm::vec4(y, y, y, radianceAt(3, 4, 1)));
  writer.channels = {"R", "G", "B", "Z"};
  writer.write(folder / "a.exr");
  EXPECT_EQ(readExr(folder / "a.exr").at(3, 4).w, 1.0f);
  writer.channels = {"R", "G", "depth"};
  writer.write(folder / "a.exr");
  EXPECT_THAT(errorOf([&] { readExr(folder / "a.exr"); }),
              HasSubstr("neither R, G and B nor Y among its channels (G, R, depth)"));
}

TEST(Exr, LuminanceWithSubsampledChroma) {
  const Folder folder;
  const int width = 64, height = 32;
  std::vector<Imf::Rgba> texels(static_cast<std::size_t>(width * height), Imf::Rgba(0.5f, 0.25f, 0.75f, 1.0f));
  {
    Imf::RgbaOutputFile file((folder / "a.exr").string().c_str(), width, height, Imf::WRITE_YC);
    file.setFrameBuffer(texels.data(), 1, static_cast<std::size_t>(width));
    file.writePixels(height);
  }
  const ImageRgb image = readHdrImage(folder / "a.exr");
  // Luminance and chroma are rounded to few bits of a half.
  const double error = glm::length(image.at(32, 16) - glm::vec3(0.5f, 0.25f, 0.75f));
  EXPECT_LE(error, 0.01);
}

TEST(Exr, FirstPartOfMany) {
  const Folder folder;
  const int width = 5, height = 4;
  std::vector<Imf::Header> headers;
  for (const char* name : {"first", "second"}) {
    Imf::Header header(width, height);
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  {
    Imf::MultiPartOutputFile file((folder / "a.exr").string().c_str(), headers.data(), 2);
    for (int p = 0; p < 2; ++p) {
      std::vector<float> values(static_cast<std::size_t>(width * height), p == 0 ? 2.0f : 7.0f);
      Imf::FrameBuffer buffer;
      for (const char* channel : {"R", "G", "B"})
        buffer.insert(channel,
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * static_cast<std::size_t>(width)));
      Imf::OutputPart part(file, p);
      part.setFrameBuffer(buffer);
      part.writePixels(height);
    }
  }
  EXPECT_EQ(readHdrImage(folder / "a.exr").at(4, 3), glm::vec3(2.0f));
}

TEST(Exr, ChromaticitiesAreConverted) {
  const Folder folder;
  ExrWriter writer;
  writer.type = Imf::FLOAT;
  // Rec.2020 has the white of Rec.709: grey stays grey, and the primaries follow ITU-R BT.2087.
  writer.chromaticities = Imf::Chromaticities({0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f});
  writer.write(folder / "a.exr");
  const ImageRgb image = readHdrImage(folder / "a.exr");
  const glm::dmat3 expected =
      glm::transpose(glm::dmat3(1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187));
  const glm::dvec3 converted = expected * glm::dvec3(radianceAt(7, 9, 0), radianceAt(7, 9, 1), radianceAt(7, 9, 2));
  // Four decimals in the recommendation, times values up to 6.
  const double error = glm::length(glm::max(converted, glm::dvec3(0.0)) - glm::dvec3(image.at(7, 9)));
  EXPECT_LE(error, 2e-3);
  // ACES has another white, to which the eye adapts: equal parts must come out as grey.
  const ExrWriter aces = [] {
    ExrWriter w;
    w.type = Imf::FLOAT;
    w.channels = {"R"};
    w.chromaticities = Imf::Chromaticities({0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});
    return w;
  }();
  Imf::Header header(2, 2);
  Imf::addChromaticities(header, *aces.chromaticities);
  std::vector<float> ones(4, 1.0f);
  Imf::FrameBuffer buffer;
  for (const char* channel : {"R", "G", "B"}) {
    header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(ones.data()), 4, 8));
  }
  {
    Imf::OutputFile file((folder / "b.exr").string().c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  const double grey = glm::length(readHdrImage(folder / "b.exr").at(1, 1) - glm::vec3(1.0f));
  EXPECT_LE(grey, 1e-5);
}

ImageRgba sampleRgba() {
  ImageRgba image;
  image.width = 5;
  image.height = 3;
  for (int i = 0; i < 15; ++i) image.texels.emplace_back(radianceAt(i, 0, 0), -1e30f, 1e-40f, 0.25f);
  return image;
}

TEST(Exr, WriteAndReadKeepsEveryBit) {
  const Folder folder;
  const ImageRgba image = sampleRgba();
  writeExr(folder / "a.exr", image);
  const ImageRgba read = readExr(folder / "a.exr");
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.texels, image.texels);
  const auto first = test::get(folder / "a.exr");
  writeExr(folder / "a.exr", image);
  EXPECT_EQ(test::get(folder / "a.exr"), first) << "two writes of one picture differ";
}

TEST(Exr, NegativeAndNotFiniteRadianceIsRefused) {
  const Folder folder;
  for (const float bad : {-1.0f, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    ImageRgba image = sampleRgba();
    for (auto& texel : image.texels) texel = glm::vec4(1.0f);
    image.at(2, 1).y = bad;
    writeExr(folder / "a.exr", image);
    EXPECT_THAT(errorOf([&] { readHdrImage(folder / "a.exr"); }), HasSubstr("texel (2, 1) is negative or not finite"));
  }
}

TEST(Exr, DamageFailsCleanly) {
  const Folder folder;
  std::mt19937 random(5);
  for (const auto compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::RLE_COMPRESSION}) {
    ExrWriter writer;
    writer.compression = compression;
    writer.tiled = compression == Imf::RLE_COMPRESSION;
    writer.write(folder / "good.exr");
    const auto good = test::get(folder / "good.exr");
    for (std::size_t length = 0; length < good.size(); length += 1 + random() % 9) {
      test::put(folder / "a.exr", std::span(good).first(length));
      ASSERT_TRUE(test::failsCleanly([&] { readExr(folder / "a.exr"); })) << length;
    }
    for (int round = 0; round < 600; ++round) {
      auto bytes = good;
      // Half of the damage goes into the header.
      for (int i = 0; i < 2; ++i)
        bytes[random() % (round % 2 == 0 ? std::min<std::size_t>(bytes.size(), 400) : bytes.size())] =
            static_cast<std::uint8_t>(random());
      test::put(folder / "a.exr", bytes);
      ASSERT_TRUE(test::failsCleanly([&] { readExr(folder / "a.exr"); }));
    }
  }
  EXPECT_THAT(errorOf([&] { readExr(test::put(folder / "a.exr", std::string("not an image at all"))); }),
              HasSubstr("is not an OpenEXR image"));
}

std::string hdrHeader(int width, int height, const std::string& more = "") {
  return "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n" + more + "\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n";
}

std::string rgbe(int r, int g, int b, int e) {
  return {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b), static_cast<char>(e)};
}

ImageRgb readHdrText(const std::string& text) {
  const Folder folder;
  return readHdrImage(test::put(folder / "a.hdr", text));
}

TEST(RadianceHdr, FlatOldAndNewRunLengths) {
  const ImageRgb flat = readHdrText(hdrHeader(2, 1) + rgbe(128, 64, 0, 129) + rgbe(0, 0, 0, 0));
  EXPECT_EQ(flat.at(0, 0), glm::vec3(1.0f, 0.5f, 0.0f));
  EXPECT_EQ(flat.at(1, 0), glm::vec3(0.0f));
  // 1 + 3 + 256 + 5 texels: a run of 3, then one of 5 + 256 * 1 in two digits.
  const ImageRgb old = readHdrText(hdrHeader(1 + 3 + 1 + 5 + 256, 1) + rgbe(128, 0, 0, 129) + rgbe(1, 1, 1, 3) +
                                   rgbe(0, 128, 0, 129) + rgbe(1, 1, 1, 5) + rgbe(1, 1, 1, 1));
  EXPECT_EQ(old.at(3, 0), glm::vec3(1, 0, 0));
  EXPECT_EQ(old.at(4, 0), glm::vec3(0, 1, 0));
  EXPECT_EQ(old.at(265, 0), glm::vec3(0, 1, 0));
  // New: width 8; red is a run, green is literal, blue mixed, exponent a run.
  const std::string row = std::string("\2\2\0\10", 4) + "\x88\x80" + std::string("\10\0\1\2\3\4\5\6\7", 9) +
                          std::string("\4\1\2\3\4\x84\7", 7) + "\x88\x81";
  const ImageRgb coded = readHdrText(hdrHeader(8, 2) + row + row);
  EXPECT_EQ(coded.at(5, 1), glm::vec3(128, 5, 7) / 128.0f);
  EXPECT_EQ(coded.at(2, 0), glm::vec3(128, 2, 3) / 128.0f);
}

TEST(RadianceHdr, ExposureAndOrientation) {
  const std::string texels = rgbe(128, 0, 0, 129) + rgbe(0, 128, 0, 129);
  EXPECT_EQ(readHdrText(hdrHeader(2, 1, "EXPOSURE=0.5\nEXPOSURE= 4\n") + texels).at(0, 0), glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(readHdrText("#?RGBE\n\n+Y 2 +X 1\n" + texels).at(0, 0), glm::vec3(0, 1, 0));
  EXPECT_EQ(readHdrText("#?RGBE\n\n-Y 1 -X 2\n" + texels).at(0, 0), glm::vec3(0, 1, 0));
}

TEST(RadianceHdr, Damage) {
  const std::string good = hdrHeader(2, 1) + rgbe(1, 2, 3, 4) + rgbe(5, 6, 7, 8);
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(errorOf([&] { readHdrText(good.substr(0, length)); }), "") << length;
  EXPECT_THAT(errorOf([&] { readHdrText(good.substr(0, good.size() - 1)); }), HasSubstr("truncated"));
  EXPECT_THAT(errorOf([&] { readHdrText("P6 " + good); }), HasSubstr("does not start with \"#?\""));
  EXPECT_THAT(errorOf([&] { readHdrText("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + rgbe(1, 2, 3, 4)); }),
              HasSubstr("32-bit_rle_xyze"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(40000, 1)); }), HasSubstr("40000x1"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(30000, 30000) + std::string(40000, 'x')); }), HasSubstr("the limits are"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(8, 1) + std::string("\2\2\0\11", 4)); }), HasSubstr("wrong length"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(8, 1) + std::string("\2\2\0\10\x89\1", 6)); }), HasSubstr("run does not fit"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(2, 1) + rgbe(1, 1, 1, 1)); }), HasSubstr("run does not fit"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(1, 1, "EXPOSURE=0\n") + rgbe(1, 2, 3, 4)); }), HasSubstr("EXPOSURE"));
  EXPECT_THAT(errorOf([&] { readHdrText(hdrHeader(1, 1, "EXPOSURE=1e-30\n") + rgbe(1, 2, 3, 255)); }), HasSubstr("not finite"));
  std::mt19937 random(6);
  const std::string row = std::string("\2\2\0\10", 4) + "\x88\x80" + std::string("\10\0\1\2\3\4\5\6\7", 9) +
                          std::string("\4\1\2\3\4\x84\7", 7) + "\x88\x81";
  const std::string coded = hdrHeader(8, 2) + row + row;
  for (int round = 0; round < 4000; ++round) {
    std::string damaged = coded;
    for (int i = 0; i < 2; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
    const std::vector<std::uint8_t> bytes(damaged.begin(), damaged.end());
    ASSERT_TRUE(test::failsCleanly([&] { decodeRadianceHdr(bytes, "damaged"); }));
  }
}

TEST(HdrImage, ByExtension) {
  EXPECT_THAT(errorOf([] { readHdrImage("a.png"); }), HasSubstr("neither .hdr nor .exr"));
  EXPECT_THAT(errorOf([] { readHdrImage("/nowhere/a.hdr"); }), HasSubstr("cannot open"));
}

TEST(Image8, PngRoundTrip) {
  const Folder folder;
  Image8 image;
  image.width = 7;
  image.height = 5;
  for (int i = 0; i < 140; ++i) image.texels.push_back(static_cast<std::uint8_t>(37 * i));
  writePng(folder / "a.png", image);
  const Image8 read = readPng(folder / "a.png");
  EXPECT_EQ(read.width, 7);
  EXPECT_EQ(read.height, 5);
  EXPECT_EQ(read.texels, image.texels);
  EXPECT_EQ(decodedSize(test::get(folder / "a.png"), "a"), glm::ivec2(7, 5));
  image.texels.pop_back();
  EXPECT_THAT(errorOf([&] { encodePng(image); }, ExitCode::failed), HasSubstr("do not fit"));
}

TEST(Image8, Jpeg) {
  const Image8 image = decodeImage8(test::tinyJpeg(), "tiny");
  ASSERT_EQ(image.width, 1);
  ASSERT_EQ(image.height, 1);
  EXPECT_EQ(image.texels, (std::vector<std::uint8_t>{128, 128, 128, 255}));
}

TEST(Image8, PngOfEveryKindBecomesRgba) {
  // 16 bit grey with alpha, 1 bit palette with transparency, and 8 bit RGB with a gamma of 1, which must change nothing.
  const auto encode = [](int bits, int color, int width, int height, const std::vector<std::uint8_t>& rows, auto more) {
    std::vector<std::uint8_t> out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &out,
        [](png_structp p, png_bytep data, std::size_t count) {
          auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(p));
          bytes.insert(bytes.end(), data, data + count);
        },
        nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, color, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    more(png, info);
    png_write_info(png, info);
    for (int y = 0; y < height; ++y)
      png_write_row(png, rows.data() + rows.size() / static_cast<std::size_t>(height) * static_cast<std::size_t>(y));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return out;
  };
  const auto nothing = [](png_structp, png_infop) {};
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(decodeImage8(encode(16, PNG_COLOR_TYPE_GRAY_ALPHA, 1, 1, {0x80, 0x80, 0x40, 0x40}, nothing), "a").texels,
            (Bytes{128, 128, 128, 64}));
  const auto palette = encode(1, PNG_COLOR_TYPE_PALETTE, 2, 1, {0x40}, [](png_structp png, png_infop info) {
    const png_color colors[2] = {{1, 2, 3}, {4, 5, 6}};
    const png_byte alpha[1] = {9};
    png_set_PLTE(png, info, colors, 2);
    png_set_tRNS(png, info, alpha, 1, nullptr);
  });
  EXPECT_EQ(decodeImage8(palette, "a").texels, (Bytes{1, 2, 3, 9, 4, 5, 6, 255}));
  const auto linear =
      encode(8, PNG_COLOR_TYPE_RGB, 1, 1, {10, 20, 30}, [](png_structp png, png_infop info) { png_set_gAMA(png, info, 1.0); });
  EXPECT_EQ(decodeImage8(linear, "a").texels, (Bytes{10, 20, 30, 255}));
}

TEST(Image8, DamageFailsCleanly) {
  std::mt19937 random(7);
  for (const auto& good : {test::tinyPng(), test::tinyJpeg()}) {
    for (std::size_t length = 0; length < good.size(); ++length) {
      // A fresh allocation of the exact size, so that a sanitizer sees any step beyond it.
      const std::vector<std::uint8_t> cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_THAT(errorOf([&] { decodeImage8(cut, "cut"); }), HasSubstr("cut: ")) << length;
    }
    for (int round = 0; round < 3000; ++round) {
      auto bytes = good;
      for (int i = 0; i < 2; ++i) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      ASSERT_TRUE(test::failsCleanly([&] { decodeImage8(bytes, "damaged"); }));
    }
  }
  EXPECT_THAT(errorOf([] {
                decodeImage8(std::vector<std::uint8_t>{'G', 'I', 'F', '8'}, "a.gif");
              }),
              HasSubstr("a.gif: is neither a PNG nor a JPEG"));
}

// 257 Huffman codes overran a table in the decoder first used here.
TEST(Image8, JpegWithTooManyHuffmanCodes) {
  auto jpeg = test::tinyJpeg();
  const std::vector<std::uint8_t> table{0xFF, 0xC4};
  const auto found = std::search(jpeg.begin(), jpeg.end(), table.begin(), table.end());
  ASSERT_NE(found, jpeg.end());
  *(found + 19) = *(found + 20) = 200;  // codes of 15 and 16 bits
  EXPECT_THAT(errorOf([&] { decodeImage8(jpeg, "codes"); }), HasSubstr("codes: the JPEG image cannot be decoded"));
}

TEST(Image8, EnormousSizesAreRefusedBeforeAnythingIsAllocated) {
  auto png = test::tinyPng();
  // IHDR width and height, big-endian, at byte 16.
  for (const std::size_t i : {std::size_t{16}, std::size_t{20}}) png[i] = 0, png[i + 1] = 0, png[i + 2] = 0x7F, png[i + 3] = 0xFF;
  EXPECT_THAT(errorOf([&] { decodeImage8(png, "big"); }), HasSubstr("32767x32767"));
}

TEST(HdrImage, EvaluationPack) {
  const auto pack = test::evaluationPack();
  if (!pack) GTEST_SKIP() << "the evaluation pack is not there (set CHIARO_DATA)";
  const ImageRgb sky = readHdrImage(*pack / "clear/hdr/kloppenheim_05_1k.hdr");
  EXPECT_EQ(sky.width, 1024);
  EXPECT_EQ(sky.height, 512);
  float peak = 0.0f;
  for (const auto& t : sky.texels) peak = std::max(peak, glm::dot(t, glm::vec3(0.2126f, 0.7152f, 0.0722f)));
  EXPECT_NEAR(peak, 7.9e4, 0.05e4) << "as the pack's README says, to its two digits";
}

}  // namespace
}  // namespace chiaro
