#pragma once
/// Names and numbers of the baked file (docs/format.md) that its writer and its reader share.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "assets/transfer/clustered.h"

namespace chiaro {

inline constexpr const char* kTransferExtension = "CHIARO_radiance_transfer";
inline constexpr const char* kTransferParameterization = "octahedral";
inline constexpr int kMostTransferResolution = 4096;
inline constexpr int kMostTransferTerms = 4096;
inline constexpr int kMostTransferDirections = 4096;
inline constexpr std::size_t kMostTransferClusters = 65535;
inline constexpr std::size_t kMostTransferFunctions = 4096;
inline constexpr std::size_t kMostTransferLevels = 16;

/// Bits a value of PackedFunctions.
inline constexpr bool isFunctionKind(int bits) { return bits == 16 || bits == 12 || bits == 8 || bits == 4; }
/// The maps of a row: SSDF, levels, then with levels the visible fractions.
inline std::size_t mapsOf(const ClusteredTransfer& c) { return 1 + c.levels.size() + (c.levels.empty() ? 0 : 1); }

/// XXH64 with seed 0, as 16 lower-case hexadecimal digits.
std::string checksumOf(std::span<const std::uint8_t> bytes);
std::string checksumOf(std::string_view text);

/// The member that holds the JSON chunk's own checksum, as it stands in the text. The sum is taken with 16 zeros in place of its digits.
std::string jsonChecksumMember(std::string_view digits);
inline constexpr std::string_view kNoChecksum = "0000000000000000";

inline constexpr std::size_t aligned4(std::size_t size) { return (size + 3) / 4 * 4; }

}  // namespace chiaro
