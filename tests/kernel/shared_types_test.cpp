// SPDX-License-Identifier: Apache-2.0
// Host and device lay the structs of kernels/shared out alike: every size and every member's offset.
#include "kernels/shared/chain_types.h"
#include "kernels/shared/escape_types.h"
#include "kernels/shared/guide_types.h"
#include "kernels/shared/measured_types.h"
#include "kernels/shared/render_types.h"
#include "kernels/shared/scene_arrays.h"
#include "probes/kernel_probe.h"
#include "support/test_device.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <regex>
#include <set>

using namespace clrt;

namespace {

struct Member {
    std::string name;
    size_t offset, size;
};

/// A shared struct as the host's compiler lays it out.
struct Layout {
    std::string name;
    size_t size;
    std::vector<Member> members;
};

// clang-format off
#define MEMBER(type, name) {#name, offsetof(type, name), sizeof(type::name)}
#define M(name) MEMBER(Triangle, name)
const Layout TRIANGLE = {
    "Triangle",
    sizeof(Triangle),
    {M(v0), M(v1), M(v2), M(n0), M(n1), M(n2), M(t0), M(t1), M(t2), M(material), M(emitter), M(object)}};
#undef M
#define M(name) MEMBER(Material, name)
const Layout MATERIAL = {
    "Material",
    sizeof(Material),
    {M(matte), M(specular), M(transmission), M(emission), M(alpha_x), M(alpha_y), M(lobes), M(fresnel),
     M(flags), M(map_matte), M(map_specular), M(map_emission), M(map_coverage), M(map_roughness),
     M(map_metallic), M(map_normal), M(map_bump), M(bump_scale), M(roughness_sqrt_x), M(roughness_sqrt_y)}};
#undef M
#define M(name) MEMBER(MaterialExtension, name)
const Layout MATERIAL_EXTENSION = {
    "MaterialExtension",
    sizeof(MaterialExtension),
    {M(attenuation), M(sheen), M(coat), M(coat_alpha), M(turn_cos), M(turn_sin), M(map_transmission),
     M(map_coat), M(map_sheen), M(map_coat_roughness), M(map_sheen_roughness), M(spread), M(priority),
     M(measured), M(map_anisotropy), M(anisotropy), M(unused0), M(unused1)}};
#undef M
#define M(name) MEMBER(MeasuredView, name)
const Layout MEASURED_VIEW = {
    "MeasuredView", sizeof(MeasuredView), {M(albedo), M(density), M(cumulative)}};
#undef M
#define M(name) MEMBER(MeasuredBrdf, name)
const Layout MEASURED_BRDF = {
    "MeasuredBrdf",
    sizeof(MeasuredBrdf),
    {M(half_count), M(difference_count), M(azimuth_count), M(scale), M(views)}};
#undef M
#define M(name) MEMBER(Texture, name)
const Layout TEXTURE = {
    "Texture",
    sizeof(Texture),
    {M(first_word), M(width), M(height), M(format), M(scale_u), M(scale_v), M(offset_u), M(offset_v),
     M(shear_u), M(shear_v), M(base), M(gain), M(wrap_u), M(wrap_v), M(channel), M(vertex_word)}};
#undef M
#define M(name) MEMBER(Instance, name)
const Layout INSTANCE = {
    "Instance",
    sizeof(Instance),
    {M(to_world), M(to_prototype), M(prototype), M(object), M(side), M(unused0)}};
#undef M
#define M(name) MEMBER(Emitter, name)
const Layout EMITTER = {
    "Emitter",
    sizeof(Emitter),
    {M(triangle), M(alias), M(threshold), M(pdf_a)}};
#undef M
#define M(name) MEMBER(EmitterPart, name)
const Layout EMITTER_PART = {
    "EmitterPart",
    sizeof(EmitterPart),
    {M(b1), M(b2), M(step), M(code)}};
#undef M
#define M(name) MEMBER(Light, name)
const Layout LIGHT = {
    "Light",
    sizeof(Light),
    {M(vector), M(emission), M(kind), M(probability), M(alias), M(threshold), M(one_minus_cos), M(axis_x),
     M(axis_y), M(axis_z)}};
#undef M
#define M(name) MEMBER(SkyTile, name)
const Layout SKY_TILE_LAYOUT = {
    "SkyTile",
    sizeof(SkyTile),
    {M(alias), M(threshold), M(probability), M(unused0), M(shares)}};
#undef M
#define M(name) MEMBER(LightNode, name)
const Layout LIGHT_NODE = {
    "LightNode",
    sizeof(LightNode),
    {M(x), M(y), M(z), M(radius), M(axis_x), M(axis_y), M(axis_z), M(chord), M(power), M(end), M(link)}};
#undef M
#define M(name) MEMBER(LightPlace, name)
const Layout LIGHT_PLACE = {
    "LightPlace",
    sizeof(LightPlace),
    {M(trail_low), M(trail_high), M(end), M(density)}};
#undef M
#define M(name) MEMBER(GuideCell, name)
const Layout GUIDE_CELL = {
    "GuideCell",
    sizeof(GuideCell),
    {M(share), M(radiance), M(light), M(unused), M(splits)}};
#undef M
#define M(name) MEMBER(Chain, name)
const Layout CHAIN = {
    "Chain",
    sizeof(Chain),
    {M(red), M(green), M(blue), M(score), M(x), M(y), M(length), M(steps), M(large_steps), M(taken_small),
     M(taken_large), M(unused0)}};
#undef M
#define M(name) MEMBER(ChainLaunch, name)
const Layout CHAIN_LAUNCH = {
    "ChainLaunch",
    sizeof(ChainLaunch),
    {M(task), M(chains), M(steps), M(paths), M(lengths), M(epoch), M(first), M(unused0)}};
#undef M
#define M(name) MEMBER(CameraParams, name)
const Layout CAMERA_PARAMS = {
    "CameraParams",
    sizeof(CameraParams),
    {M(eye), M(film_dx), M(film_dy), M(look), M(eye_move), M(way), M(way_move), M(up), M(up_move),
     M(pixel_x), M(pixel_y), M(shift_x), M(shift_y), M(lens_radius), M(inverse_focus), M(blades), M(moves),
     M(projection), M(unused0), M(unused1), M(unused2)}};
#undef M
#define M(name) MEMBER(RenderParams, name)
const Layout RENDER_PARAMS = {
    "RenderParams",
    sizeof(RenderParams),
    {M(camera), M(environment), M(background), M(width), M(height),
     M(crop_x), M(crop_y), M(crop_width), M(crop_height), M(first_sample), M(sample_count), M(replicates), M(first_replicate),
     M(dealt_replicates),
     M(film_replicates), M(seed), M(epoch), M(max_depth), M(min_contribution), M(filter), M(filter_radius), M(patch_gap), M(patch_last),
     M(scene_extent), M(emitter_count), M(light_count), M(environment_width), M(environment_height),
     M(environment_cos), M(environment_sin), M(choose_emitter), M(choose_environment), M(choose_light),
     M(roulette_depth), M(emit_emitter), M(emit_environment), M(emit_light), M(emission_radius), M(quantum), M(inverse_quantum), M(largest_contribution), M(tile_count), M(tiles_x),
     M(tile_stride), M(first_tile), M(end_tile), M(guide_learns), M(caster_count), M(caster_squares), M(light_path_count),
     M(environment_format), M(texture_filter), M(portal_count), M(portal_share), M(path_choices), M(shadow_rays), M(gloss_rays), M(translucent_rays), M(unused0)}};
#undef M
#define M(name) MEMBER(SkyPortal, name)
const Layout SKY_PORTAL = {
    "SkyPortal",
    sizeof(SkyPortal),
    {M(corner), M(axis_u), M(axis_v), M(normal), M(first_sum), M(unused0), M(unused1), M(unused2)}};
#undef M
#define M(name) MEMBER(Escape, name)
const Layout ESCAPE = {
    "Escape",
    sizeof(Escape),
    {M(origin), M(direction)}};
#undef M
#define M(name) MEMBER(PathState, name)
const Layout PATH_STATE = {
    "PathState",
    sizeof(PathState),
    {M(next), M(layers), M(unused0), M(unused1), M(unused2)}};
#undef M
#define M(name) MEMBER(ArrayPlace, name)
const Layout ARRAY_PLACE_LAYOUT = {
    "ArrayPlace",
    sizeof(ArrayPlace),
    {M(heap), M(first), M(is_empty), M(unused0)}};
#undef M
#define M(type, name, member) MEMBER(ArrayPlaces, name),
const Layout ARRAY_PLACES = {
    "ArrayPlaces",
    sizeof(ArrayPlaces),
    {BVH_ARRAYS(M) SCENE_ARRAYS(M) PATH_ARRAYS(M)}};
#undef M
// clang-format on

const std::vector<Layout> LAYOUTS = {TRIANGLE,      MATERIAL,        MATERIAL_EXTENSION, TEXTURE,
                                     EMITTER,       MEASURED_VIEW,   MEASURED_BRDF,      INSTANCE,
                                     LIGHT,         SKY_TILE_LAYOUT, LIGHT_NODE,         LIGHT_PLACE,
                                     CAMERA_PARAMS, RENDER_PARAMS,   ARRAY_PLACE_LAYOUT, ARRAY_PLACES,
                                     GUIDE_CELL,    CHAIN,           CHAIN_LAUNCH,       EMITTER_PART,
                                     SKY_PORTAL,    ESCAPE,          PATH_STATE};

/// A kernel that writes the size of a struct and the offsets of its members, by OpenCL C 1.2 alone: it has no
/// offsetof.
std::string layout_kernel(const Layout& layout) {
    std::string text = fmt::format("__kernel void layout_{0}(__global u32 *restrict out) {{\n"
                                   "    {0} object;\n"
                                   "    out[0] = (u32)sizeof(object);\n",
                                   layout.name);
    for (size_t i = 0; i < layout.members.size(); ++i)
        text += fmt::format("    out[{}] = (u32)((const uchar *)&object.{} - (const uchar *)&object);\n",
                            i + 1, layout.members[i].name);
    return text + "}\n";
}

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(),
                         {"shared/scene_arrays.h", "shared/measured_types.h", "shared/render_types.h",
                          "shared/guide_types.h", "shared/chain_types.h", "shared/escape_types.h"});
        for (const Layout& layout : LAYOUTS)
            made.add_text(layout_kernel(layout));
        made.add_text(
            "__kernel void receive_params(const RenderParams params, __global RenderParams *restrict out) {\n"
            "    *out = params;\n}\n");
        return made;
    }();
    return instance;
}

} // namespace

TEST(SharedTypes, EveryStructOfTheSharedHeadersIsListedHere) {
    const std::regex definition("\\}\\s*(\\w+)\\s*;");
    std::set<std::string> in_headers, listed;
    for (const auto& [file, text] : embedded_kernel_files())
        if (file.rfind("shared/", 0) == 0 && file != "shared/types.h")
            for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match)
                in_headers.insert((*match)[1]);
    for (const Layout& layout : LAYOUTS)
        listed.insert(layout.name);
    EXPECT_EQ(listed, in_headers);
}

TEST(SharedTypes, MembersFillTheirStructs) {
    for (const Layout& layout : LAYOUTS) {
        size_t end = 0;
        for (const Member& member : layout.members) {
            EXPECT_EQ(member.offset, end)
                << layout.name << "." << member.name << ": unnamed padding before it";
            end = member.offset + member.size;
        }
        EXPECT_EQ(layout.size, end) << layout.name
                                    << ": a member is not listed here, or unnamed padding at the end";
        EXPECT_EQ(layout.size % 16, 0u) << layout.name;
    }
}

TEST(SharedTypes, TheDeviceLaysStructsOutLikeTheHost) {
    for (const Layout& layout : LAYOUTS) {
        const cl::Buffer out =
            create_buffer(test_device(), "layout", (layout.members.size() + 1) * sizeof(u32));
        Kernel kernel = probe().kernel("layout_" + layout.name);
        kernel.set("out", out);
        probe().launch(kernel, 1, 1);
        const std::vector<u32> on_device = probe().read<u32>(out, layout.members.size() + 1);
        EXPECT_EQ(on_device[0], layout.size) << layout.name;
        for (size_t i = 0; i < layout.members.size(); ++i)
            EXPECT_EQ(on_device[i + 1], layout.members[i].offset)
                << layout.name << "." << layout.members[i].name;
    }
}

TEST(SharedTypes, ParametersPassedByValueArriveIntact) {
    std::array<u32, sizeof(RenderParams) / sizeof(u32)> words;
    for (size_t i = 0; i < words.size(); ++i)
        words[i] = static_cast<u32>(0x40000000u + i * 0x10001u); // ordinary floats, all different
    RenderParams params;
    std::memcpy(&params, words.data(), sizeof params);

    const cl::Buffer out = create_buffer(test_device(), "params", sizeof params);
    Kernel kernel = probe().kernel("receive_params");
    kernel.set("params", params);
    kernel.set("out", out);
    probe().launch(kernel, 1, 1);
    EXPECT_EQ(probe().read<u32>(out, words.size()), std::vector<u32>(words.begin(), words.end()));
}
