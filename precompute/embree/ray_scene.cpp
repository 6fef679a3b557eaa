#include "precompute/embree/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "assets/error.h"
#include "precompute/embree/embree_compat.h"
#include "precompute/reference/texture_sampler.h"

namespace chiaro {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What the filter of one alpha-masked primitive needs.
struct AlphaMask {
  const Primitive* primitive = nullptr;
  TextureSampler texture;
  float factor = 1.0f;
  float cutoff = 0.5f;

  bool isHole(std::uint32_t triangle, glm::vec2 barycentric) const {
    return factor * texture.at(texcoordAt(*primitive, triangle, barycentric)).a < cutoff;
  }
};

/// Embree calls this for each candidate hit of one ray or of a packet; a hit in a hole is refused.
void refuseHoles(const RTCFilterFunctionNArguments* arguments) {
  const auto& mask = *static_cast<const AlphaMask*>(arguments->geometryUserPtr);
  for (unsigned int i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const glm::vec2 barycentric(RTCHitN_u(arguments->hit, arguments->N, i), RTCHitN_v(arguments->hit, arguments->N, i));
    if (mask.isHole(triangle, barycentric)) arguments->valid[i] = 0;
  }
}

template <auto release>
struct Releaser {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>>;
using GeometryHandle = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser<rtcReleaseGeometry>>;

bool isFinite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

RTCRay makeRay(glm::vec3 origin, glm::vec3 direction, float tnear, float tfar) {
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.tnear = tnear;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = tfar;
  ray.mask = ~0u;
  return ray;
}

/// In double: the cross product of two edges of 1e-12 m is denormal in float.
glm::vec3 geometricNormal(const Primitive& primitive, std::uint32_t triangle) {
  const std::uint32_t* corner = &primitive.indices[3 * static_cast<std::size_t>(triangle)];
  const glm::dvec3 a(primitive.positions[corner[0]]);
  const glm::dvec3 b(primitive.positions[corner[1]]);
  const glm::dvec3 c(primitive.positions[corner[2]]);
  return glm::vec3(glm::normalize(glm::cross(b - a, c - a)));
}

}  // namespace

struct RayScene::Impl {
  // One build thread, so that the tree, and with it the choice between two surfaces in the same place, is the same on every
  // machine.
  explicit Impl(const Scene& source) : scene(&source), bounds(boundsOf(source)), device(rtcNewDevice("threads=1")) {
    if (!device) throw Error(ExitCode::failed, "embree", "no ray tracing device", "check the Embree installation");
    everything = newScene();
    // Embree's ray masks are a build option that Debian leaves off, so what occludes is a scene of its own where it differs.
    const bool anyBlended =
        std::ranges::any_of(source.primitives, [&](const Primitive& primitive) { return isBlended(primitive); });
    if (anyBlended) occludersOnly = newScene();
    masks.reserve(source.primitives.size());  // filters point into it
    for (std::size_t i = 0; i < source.primitives.size(); ++i) attach(static_cast<std::uint32_t>(i));
    rtcCommitScene(everything.get());
    if (occludersOnly) rtcCommitScene(occludersOnly.get());
    throwOnDeviceError();
  }

  RTCScene occluders() const { return occludersOnly ? occludersOnly.get() : everything.get(); }

  bool isBlended(const Primitive& primitive) const { return materialOf(*scene, primitive).alphaMode == AlphaMode::blend; }

  SceneHandle newScene() const {
    SceneHandle result(rtcNewScene(device.get()));
    rtcSetSceneFlags(result.get(), RTC_SCENE_FLAG_ROBUST);
    return result;
  }

  void attach(std::uint32_t index) {
    const Primitive& primitive = scene->primitives[index];
    if (primitive.indices.empty()) return;
    const Material& material = materialOf(*scene, primitive);
    const bool masked = material.alphaMode == AlphaMode::mask;
    const bool textured = masked && material.baseColorTexture != kNone;
    if (masked && !textured && material.baseColorFactor.a < material.alphaCutoff) return;  // all of it is a hole

    const GeometryHandle geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    copyIntoBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, primitive.positions.data(),
                   primitive.positions.size(), sizeof(glm::vec3));
    copyIntoBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, primitive.indices.data(), primitive.triangleCount(),
                   3 * sizeof(std::uint32_t));
    if (textured) {
      masks.push_back({&primitive, TextureSampler(*scene, material.baseColorTexture, TextureEncoding::srgb),
                       material.baseColorFactor.a, material.alphaCutoff});
      rtcSetGeometryUserData(geometry.get(), &masks.back());
      rtcSetGeometryIntersectFilterFunction(geometry.get(), refuseHoles);
      rtcSetGeometryOccludedFilterFunction(geometry.get(), refuseHoles);
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(everything.get(), geometry.get(), index);
    if (occludersOnly && !isBlended(primitive)) rtcAttachGeometryByID(occludersOnly.get(), geometry.get(), index);
  }

  static void copyIntoBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const void* data, std::size_t count,
                             std::size_t stride) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
    if (buffer == nullptr) throw Error(ExitCode::failed, "embree", "not enough memory for the triangles", "use a smaller scene");
    std::memcpy(buffer, data, count * stride);
  }

  void throwOnDeviceError() const {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_NONE) return;
    throw Error(ExitCode::failed, "embree",
                "error " + std::to_string(static_cast<int>(error)) + " while building the ray tracing tree",
                error == RTC_ERROR_OUT_OF_MEMORY ? "use a smaller scene" : "check the Embree installation");
  }

  const Scene* scene;
  Bounds bounds;
  DeviceHandle device;
  std::vector<AlphaMask> masks;
  SceneHandle everything;
  SceneHandle occludersOnly;  ///< null where everything occludes
};

RayScene::RayScene(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

bool RayScene::intersect(glm::vec3 origin, glm::vec3 direction, float tnear, float tfar, RayHit& hit) const {
  if (!isFinite(origin) || !isFinite(direction)) return false;
  RTCRayHit query{};
  query.ray = makeRay(origin, direction, tnear, tfar);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect1(impl_->everything.get(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.distance = query.ray.tfar;
  hit.primitive = query.hit.geomID;
  hit.triangle = query.hit.primID;
  hit.barycentric = {query.hit.u, query.hit.v};
  hit.geometricNormal = geometricNormal(impl_->scene->primitives[hit.primitive], hit.triangle);
  return true;
}

bool RayScene::occluded(glm::vec3 origin, glm::vec3 direction, float tnear, float tfar) const {
  if (!isFinite(origin) || !isFinite(direction)) return false;
  RTCRay ray = makeRay(origin, direction, tnear, tfar);
  embree::occluded1(impl_->occluders(), ray);
  return ray.tfar == -kInfinity;  // Embree's mark
}

std::uint32_t RayScene::occluded16(glm::vec3 origin, const float* x, const float* y, const float* z, std::uint32_t active,
                                   float tnear, float tfar) const {
  if (!isFinite(origin)) return 0;
  alignas(64) RTCRay16 rays;
  alignas(64) int valid[16];
  std::memcpy(rays.dir_x, x, sizeof(rays.dir_x));
  std::memcpy(rays.dir_y, y, sizeof(rays.dir_y));
  std::memcpy(rays.dir_z, z, sizeof(rays.dir_z));
  for (int i = 0; i < 16; ++i) {
    // A sum is finite only where each direction component is (unit vectors do not overflow).
    valid[i] = ((active >> i) & 1u) != 0u && std::isfinite(x[i] + y[i] + z[i]) ? -1 : 0;
    rays.org_x[i] = origin.x;
    rays.org_y[i] = origin.y;
    rays.org_z[i] = origin.z;
    rays.tnear[i] = tnear;
    rays.tfar[i] = tfar;
    rays.time[i] = 0.0f;
    rays.mask[i] = ~0u;
    rays.id[i] = 0;
    rays.flags[i] = 0;
  }
  embree::occluded16(valid, impl_->occluders(), rays);
  std::uint32_t result = 0;
  for (int i = 0; i < 16; ++i) result |= (rays.tfar[i] == -kInfinity ? 1u : 0u) << i;
  return result & active;
}

struct OcclusionPacket::Impl {
  RTCScene scene;
  bool nothing = false;  ///< the origin is not finite
  alignas(64) RTCRay16 rays;
  alignas(64) int valid[16];
};

OcclusionPacket::OcclusionPacket(const RayScene& rays) : impl_(std::make_unique<Impl>()) {
  impl_->scene = rays.impl_->occluders();
  impl_->rays = {};
  std::ranges::fill(impl_->rays.mask, ~0u);
}

OcclusionPacket::~OcclusionPacket() = default;
OcclusionPacket::OcclusionPacket(OcclusionPacket&&) noexcept = default;
OcclusionPacket& OcclusionPacket::operator=(OcclusionPacket&&) noexcept = default;

void OcclusionPacket::setOrigin(glm::vec3 origin) {
  impl_->nothing = !isFinite(origin);
  std::ranges::fill(impl_->rays.org_x, origin.x);
  std::ranges::fill(impl_->rays.org_y, origin.y);
  std::ranges::fill(impl_->rays.org_z, origin.z);
}

std::uint32_t OcclusionPacket::operator()(const float* x, const float* y, const float* z, std::uint32_t active) {
  if (impl_->nothing) return 0;
  auto& rays = impl_->rays;
  std::memcpy(rays.dir_x, x, sizeof(rays.dir_x));
  std::memcpy(rays.dir_y, y, sizeof(rays.dir_y));
  std::memcpy(rays.dir_z, z, sizeof(rays.dir_z));
  std::ranges::fill(rays.tfar, kInfinity);  // Embree changes nothing else
  for (int i = 0; i < 16; ++i) impl_->valid[i] = -static_cast<int>(active >> i & 1u);
  embree::occluded16(impl_->valid, impl_->scene, rays);
  std::uint32_t result = 0;
  for (int i = 0; i < 16; ++i) result |= (rays.tfar[i] == -kInfinity ? 1u : 0u) << i;
  return result & active;
}

float RayScene::surfaceOffset(glm::vec3 position) const {
  // Positions are rounded to half a float epsilon of their largest coordinate, interpolated ones to a few; Embree's robust
  // intersection is good to a few epsilons of the distances involved, which the diagonal bounds.
  constexpr float kScene = 1e-5f;
  constexpr float kPosition = 32.0f * std::numeric_limits<float>::epsilon();
  const glm::vec3 magnitude = glm::abs(position);
  return std::max(kScene * impl_->bounds.diagonal(), kPosition * std::max({magnitude.x, magnitude.y, magnitude.z}));
}

}  // namespace chiaro
