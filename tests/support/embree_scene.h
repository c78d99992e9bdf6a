// SPDX-License-Identifier: Apache-2.0
// The same triangles in Embree, in its robust mode. Header only: just the tests that include it link Embree.
#pragma once

#include "kernels/shared/scene_types.h"

#include <embree3/rtcore.h>
#include <vector>

namespace clrt {

/// A closest hit as Embree gives it.
struct EmbreeHit {
    float t, u, v;
    u32 triangle; ///< NO_INDEX: a miss
};

/// Positions and triangles must outlive the object: Embree reads them in place.
class EmbreeScene {
public:
    EmbreeScene(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles)
        : device_(rtcNewDevice("threads=2")), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(),
                                   0, sizeof(vec4), positions.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                                   sizeof(Triangle), triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    /// The closest hit up to `t_max` (w of both vectors is ignored).
    EmbreeHit closest(const vec4& origin, const vec4& direction, float t_max) const {
        RTCRayHit query{};
        query.ray.org_x = origin.x, query.ray.org_y = origin.y, query.ray.org_z = origin.z;
        query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
        query.ray.tfar = t_max;
        query.ray.mask = ~0u;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &query);
        const bool is_hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        return {query.ray.tfar, query.hit.u, query.hit.v, is_hit ? query.hit.primID : NO_INDEX};
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

} // namespace clrt
