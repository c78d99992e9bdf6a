// SPDX-License-Identifier: Apache-2.0
#include "app/peer_names.h"

#include <cctype>

namespace clrt {

namespace {

/// Without what spellings differ in: samplesPerPixel, samples_per_pixel, --samples-per-pixel.
std::string squeezed(const std::string& name) {
    std::string letters;
    for (const char c : name)
        if (c != '-' && c != '_')
            letters += char(std::tolower(static_cast<unsigned char>(c)));
    return letters;
}

} // namespace

// From the help pages of Cycles, Blender, pbrt-v4, Mitsuba 3, LuxCore, appleseed, Arnold's kick, OSPRay
// Studio, Yocto/GL and F3D, and the keys of POV-Ray's and LuxCore's files.
const std::vector<std::pair<const char*, const char*>>& peer_names() {
    static const std::vector<std::pair<const char*, const char*>> names = {
        // samples and when to stop
        {"samples", "--spp N"},
        {"sample-count", "--spp N"},
        {"num-samples", "--spp N"},
        {"max-samples", "--spp N"},
        {"samples-per-pixel", "--spp N"},
        {"aa-samples", "--spp N"},
        {"halt-spp", "--spp N"},
        {"quality", "--spp N or --error X"},
        {"noise-threshold", "--error X"},
        {"halt-threshold", "--error X"},
        {"target-error", "--error X"},
        {"time-limit", "--time DURATION"},
        {"max-time", "--time DURATION"},
        {"halt-time", "--time DURATION"},
        {"timeout", "--time DURATION"},
        {"rng-seed", "--seed N"},
        {"noise-seed", "--seed N"},
        {"random-seed", "--seed N"},
        // paths
        {"bounces", "--max-depth N"},
        {"max-bounces", "--max-depth N"},
        {"num-bounces", "--max-depth N"},
        {"depth", "--max-depth N"},
        {"path-depth", "--max-depth N"},
        {"max-path-length", "--max-depth N"},
        {"max-trace-level", "--max-depth N"},
        {"rr-depth", "--roulette-depth N"},
        {"engine", "--integrator NAME"},
        {"render-engine", "--integrator NAME"},
        {"renderer", "--integrator NAME"},
        // the machine
        {"gpu", "--device gpu"},
        {"cuda", "--device gpu"},
        {"optix", "--device gpu"},
        {"gpu-device", "--device NAME"},
        {"cycles-device", "--device NAME"},
        {"backend", "--device NAME"},
        {"platform", "--device NAME"},
        {"cpu", "--device cpu"},
        {"nthreads", "--threads N"},
        {"num-threads", "--threads N"},
        {"jobs", "--threads N"},
        {"cores", "--threads N"},
        {"work-threads", "--threads N"},
        {"fp64", "--precision double"},
        {"float64", "--precision double"},
        // the picture
        {"resolution", "--size WxH"},
        {"res", "--size WxH"},
        {"width", "--size WxH"},
        {"height", "--size WxH"},
        {"dimensions", "--size WxH"},
        {"image-size", "--size WxH"},
        {"film-size", "--size WxH"},
        {"out", "--output FILE"},
        {"outfile", "--output FILE"},
        {"output-file", "--output FILE"},
        {"output-file-name", "--output FILE"},
        {"output-path", "--output FILE"},
        {"render-output", "--output FILE"},
        {"window", "--crop X0,Y0,X1,Y1"},
        {"crop-window", "--crop X0,Y0,X1,Y1"},
        {"pixel-bounds", "--crop X0,Y0,X1,Y1"},
        {"render-region", "--crop X0,Y0,X1,Y1"},
        {"region", "--crop X0,Y0,X1,Y1"},
        {"pixel-filter", "--filter NAME"},
        {"reconstruction-filter", "--filter NAME"},
        {"rfilter", "--filter NAME"},
        {"ev", "--exposure EV"},
        {"auto-exposure", "--exposure auto"},
        {"tone-mapping", "--tonemap NAME"},
        {"tonemapper", "--tonemap NAME"},
        {"view-transform", "--tonemap NAME"},
        {"filmic", "--tonemap filmic"},
        {"agx", "--tonemap agx"},
        {"layers", "--aov LIST"},
        {"render-passes", "--aov LIST"},
        // camera
        {"camera-position", "--eye X,Y,Z"},
        {"position", "--eye X,Y,Z"},
        {"origin", "--eye X,Y,Z"},
        {"look-at", "--at X,Y,Z"},
        {"target", "--at X,Y,Z"},
        {"camera-focal-point", "--at X,Y,Z"},
        {"view-up", "--up X,Y,Z"},
        {"camera-view-up", "--up X,Y,Z"},
        {"fovy", "--fov DEG"},
        {"camera-fov", "--fov DEG"},
        {"camera-view-angle", "--fov DEG"},
        {"angle", "--fov DEG"},
        {"sensor-width", "--film-width X"},
        {"camera-orthographic", "--projection orthographic"},
        {"ortho", "--projection orthographic"},
        {"ortho-scale", "--ortho-height X"},
        {"camera-type", "--projection NAME"},
        {"panorama", "--projection equirectangular"},
        {"lens-shift", "--shift X,Y"},
        {"lens-radius", "--aperture D"},
        {"aperture-size", "--aperture D"},
        {"f-number", "--fstop N"},
        {"aperture-fstop", "--fstop N"},
        {"focal-distance", "--focus D"},
        {"focus-distance", "--focus D"},
        {"aperture-blades", "--blades N"},
        {"shutter-open", "--shutter OPEN,CLOSE"},
        {"shutter-close", "--shutter OPEN,CLOSE"},
        // light and materials
        {"envmap", "--env FILE"},
        {"envname", "--env FILE"},
        {"environment", "--env FILE"},
        {"environment-map", "--env FILE"},
        {"hdr", "--env FILE"},
        {"hdri", "--env FILE"},
        {"hdri-file", "--env FILE"},
        {"ibl", "--env FILE"},
        {"skybox", "--env FILE"},
        {"world", "--env FILE"},
        {"point-light", "--point X,Y,Z,R,G,B"},
        {"spot-light", "--spot X,Y,Z,DX,DY,DZ,R,G,B"},
        {"sun-direction", "--sun X,Y,Z,R,G,B"},
        {"override-shading", "--material clay"},
        {"clay", "--material clay"},
        // runs
        {"continue", "--resume FILE"},
        {"film", "--checkpoint FILE"},
        {"save-interval", "--save-every DURATION"},
        {"write-interval", "--save-every DURATION"},
        {"continuous-saving", "--save-every DURATION"},
        {"write-partial-images", "--save-every DURATION"},
        {"statistics", "--stats FILE"},
        {"json", "--stats FILE"},
        {"dry-run", "--explain"},
        {"debug", "--verbose"},
        {"log-level", "--verbose or --quiet"},
        {"verbosity", "--verbose or --quiet"},
        {"silent", "--quiet"},
    };
    return names;
}

std::string name_here(const std::string& typed) {
    for (const auto& [peer, ours] : peer_names())
        if (squeezed(peer) == squeezed(typed))
            return ours;
    return "";
}

} // namespace clrt
