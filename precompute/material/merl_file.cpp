#include "precompute/material/merl_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/material/xz_file.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

constexpr std::array<double, 3> kScale{1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::array<std::uint32_t, 3> kSizes{MerlTable::kThetaHalf, MerlTable::kThetaDiff, MerlTable::kPhiDiff};

std::uint64_t littleEndian(std::span<const std::uint8_t> bytes) {
  std::uint64_t word = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) word = word << 8 | bytes[i];
  return word;
}

std::size_t indexOf(std::size_t h, std::size_t d, std::size_t p) {
  return p + MerlTable::kPhiDiff * (d + MerlTable::kThetaDiff * h);
}

}  // namespace

double MerlTable::thetaHalfOf(std::size_t bin) {
  const double root = (static_cast<double>(bin) + 0.5) / kThetaHalf;
  return root * root * lobe64::kHalfPi;
}
double MerlTable::thetaDiffOf(std::size_t bin) { return (static_cast<double>(bin) + 0.5) / kThetaDiff * lobe64::kHalfPi; }
double MerlTable::phiDiffOf(std::size_t bin) { return (static_cast<double>(bin) + 0.5) / kPhiDiff * lobe64::kPi; }

Vec3 MerlTable::bin(std::size_t h, std::size_t d, std::size_t p) const {
  const std::size_t i = indexOf(h, d, p);
  return Vec3(static_cast<double>(values_[i]), static_cast<double>(values_[i + kBins]),
              static_cast<double>(values_[i + 2 * kBins]));
}

Vec3 MerlTable::at(const HalfDifference& angles) const {
  const double turns = angles.phiDiff / lobe64::kPi;
  const double place[3] = {std::sqrt(std::max(angles.thetaHalf, 0.0) / lobe64::kHalfPi) * kThetaHalf - 0.5,
                           angles.thetaDiff / lobe64::kHalfPi * kThetaDiff - 0.5, (turns - std::floor(turns)) * kPhiDiff - 0.5};
  std::size_t low[3];
  double share[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double floor = std::floor(place[k]);
    if (!(std::abs(floor) < 1e6)) return Vec3(lobe64::notANumber());
    low[k] = static_cast<std::size_t>(floor + 1.0);  // one too many, so that -1 is no negative number
    share[k] = place[k] - floor;
  }
  Vec3 sum(0.0);
  double total = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::size_t at[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const bool upper = (corner >> k & 1) != 0;
      weight *= upper ? share[k] : 1.0 - share[k];
      const std::size_t index = low[k] + (upper ? 1 : 0);  // still one too many
      at[k] = k == 2 ? (index + kPhiDiff - 1) % kPhiDiff : std::clamp<std::size_t>(index, 1, kSizes[k]) - 1;
    }
    if (!(weight > 0.0)) continue;
    const Vec3 value = bin(at[0], at[1], at[2]);
    if (std::isnan(value.x + value.y + value.z)) continue;
    sum += weight * value;
    total += weight;
  }
  return total > 0.0 ? sum / total : Vec3(lobe64::notANumber());
}

double MerlTable::measuredShare() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kBins; ++i) count += std::isnan(values_[i]) ? 0 : 1;
  return static_cast<double>(count) / kBins;
}

MerlTable readMerl(std::span<const std::uint8_t> file, const std::string& where) {
  if (file.size() < 12) throw inputError(where, "is cut short: not even the 12 bytes of its header are there", "copy it again");
  for (std::size_t k = 0; k < 3; ++k) {
    const auto size = littleEndian(file.subspan(4 * k, 4));
    if (size != kSizes[k])
      throw inputError(where,
                       "its header is not 90, 90, 180: number " + std::to_string(k + 1) + " is " +
                           std::to_string(static_cast<std::int32_t>(size)),
                       "name a .binary file of the MERL layout");
  }
  if (file.size() != MerlTable::kFileBytes)
    throw inputError(where,
                     (file.size() < MerlTable::kFileBytes ? "is cut short: it has " : "is too long: it has ") +
                         std::to_string(file.size()) + " of " + std::to_string(MerlTable::kFileBytes) + " bytes",
                     "copy it again");
  std::vector<float> values(3 * MerlTable::kBins);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto bits = littleEndian(file.subspan(12 + 8 * i, 8));
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    const double scaled = value * kScale[i / MerlTable::kBins];
    if (!(std::abs(scaled) <= 1e30))
      throw inputError(where, "value " + std::to_string(i) + " is not finite", "measure or convert it again");
    values[i] = value < 0.0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(scaled);
  }
  // A bin counts as measured when all its channels were.
  bool any = false;
  for (std::size_t i = 0; i < MerlTable::kBins; ++i) {
    const bool measured = !std::isnan(values[i] + values[i + MerlTable::kBins] + values[i + 2 * MerlTable::kBins]);
    any = any || measured;
    if (!measured)
      for (std::size_t c = 0; c < 3; ++c) values[i + c * MerlTable::kBins] = std::numeric_limits<float>::quiet_NaN();
  }
  if (!any) throw inputError(where, "has no measured value: all are negative", "measure or convert it again");
  return MerlTable(std::move(values));
}

MerlTable readMerlFile(const std::filesystem::path& path) {
  auto bytes = readFile(path);
  if (path.extension() == ".xz") bytes = unpackedXz(bytes, MerlTable::kFileBytes, path.string());
  return readMerl(bytes, path.string());
}

std::vector<std::uint8_t> merlFileOf(const ReflectanceFunction& reflectance) {
  std::vector<std::uint8_t> file;
  file.reserve(MerlTable::kFileBytes);
  const auto append = [&](std::uint64_t word, int bytes) {
    for (int i = 0; i < bytes; ++i) file.push_back(static_cast<std::uint8_t>(word >> 8 * i & 255));
  };
  for (const auto size : kSizes) append(size, 4);
  std::vector<Vec3> values(MerlTable::kBins);
  for (std::size_t h = 0; h < MerlTable::kThetaHalf; ++h)
    for (std::size_t d = 0; d < MerlTable::kThetaDiff; ++d)
      for (std::size_t p = 0; p < MerlTable::kPhiDiff; ++p) {
        const auto pair = directionPair({MerlTable::thetaHalfOf(h), MerlTable::thetaDiffOf(d), MerlTable::phiDiffOf(p)});
        values[indexOf(h, d, p)] =
            pair.wo.z > 0.0 && pair.wi.z > 0.0 ? reflectance(pair.wo, pair.wi) : Vec3(lobe64::notANumber());
      }
  for (int c = 0; c < 3; ++c)
    for (const auto& value : values) {
      const double stored = std::isnan(value[c]) ? -1.0 : value[c] / kScale[static_cast<std::size_t>(c)];
      std::uint64_t bits = 0;
      std::memcpy(&bits, &stored, sizeof bits);
      append(bits, 8);
    }
  return file;
}

}  // namespace chiaro
