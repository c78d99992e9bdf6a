// SPDX-License-Identifier: Apache-2.0
#include "bench/embree_side.h"

#include "bench/measure.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

bool count_bytes(void* counter, ssize_t bytes, bool) {
    static_cast<std::atomic<long long>*>(counter)->fetch_add(bytes);
    return true;
}

RTCRay make_ray(const BenchRay& ray) {
    RTCRay query{};
    query.org_x = ray.origin.x, query.org_y = ray.origin.y, query.org_z = ray.origin.z;
    query.dir_x = ray.direction.x, query.dir_y = ray.direction.y, query.dir_z = ray.direction.z;
    query.tfar = ray.origin.w;
    query.mask = ~0u;
    return query;
}

} // namespace

EmbreeSide::EmbreeSide(const Scene& scene, bool robust, int threads, const std::string& isa) {
    const std::string config =
        fmt::format("threads={}{}{}", std::max(threads, 0), isa.empty() ? "" : ",isa=", isa);
    device_ = rtcNewDevice(config.c_str());
    if (!device_)
        throw std::runtime_error(
            fmt::format("Embree cannot start (error {})", int(rtcGetDeviceError(nullptr))));
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, scene.positions.data(),
                               0, sizeof(vec4), scene.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, scene.triangles.data(),
                               0, sizeof(Triangle), scene.triangles.size());
    build_cost_ = measure([&] {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcCommitScene(scene_);
    });
    rtcReleaseGeometry(geometry);
    const RTCError error = rtcGetDeviceError(device_);
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(fmt::format("Embree cannot build its tree (error {})", int(error)));
}

EmbreeSide::~EmbreeSide() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

BenchHit EmbreeSide::closest(const BenchRay& ray) const {
    RTCRayHit query;
    query.ray = make_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return {query.ray.tfar, 0, 0, NO_INDEX};
    return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
}

BenchHit EmbreeSide::any(const BenchRay& ray) const {
    RTCRay query = make_ray(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &query);
    // Embree marks an occluded ray by a tfar below 0.
    return {ray.origin.w, 0, 0, query.tfar < 0 ? 0 : NO_INDEX};
}

void EmbreeSide::trace(bool any_hit, const std::vector<BenchRay>& rays, std::vector<BenchHit>& hits) const {
    hits.resize(rays.size());
    const size_t blocks = (rays.size() + RAYS_PER_BLOCK - 1) / RAYS_PER_BLOCK;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks), [&](const tbb::blocked_range<size_t>& range) {
        const size_t end = std::min(range.end() * RAYS_PER_BLOCK, rays.size());
        if (any_hit)
            for (size_t i = range.begin() * RAYS_PER_BLOCK; i < end; ++i)
                hits[i] = any(rays[i]);
        else
            for (size_t i = range.begin() * RAYS_PER_BLOCK; i < end; ++i)
                hits[i] = closest(rays[i]);
    });
}

std::string embree_version() {
    return RTC_VERSION_STRING;
}

} // namespace clrt
