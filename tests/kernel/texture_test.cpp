// SPDX-License-Identifier: Apache-2.0
// geometry/texture.h: texel formats, bilinear lookup with wrapping and clamping, orientation, channels.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "scene/texture_levels.h"
#include "support/test_device.h"

#include <array>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

constexpr u32 LUMINANCE = 4;
constexpr size_t SRGB_WORDS = 256; // the curve stands before all texels

using Texel = std::array<double, 4>;

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"geometry/texture.h"});
        made.add("lookup",
                 "first = texture_lookup(scene, 0u, uv_make(a.x, a.y), (UvArea)(a.z));"
                 "second = probe_vec4(texture_color(scene, 0u, uv_make(a.x, a.y), (UvArea)(a.z)), REAL(0.0));"
                 "third.x = texture_scalar(scene, 0u, uv_make(a.x, a.y), (UvArea)(a.z));");
        made.add("pairs", "first = texture_lookup(scene, 0u, (Uv)(a), (UvArea)(b.x, b.y));");
        return made;
    }();
    return instance;
}

/// IEC 61966-2-1.
double srgb(u32 byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// A picture and its one use.
struct Picture {
    Scene scene;

    Picture(u32 width, u32 height, u32 format) {
        for (u32 i = 0; i < SRGB_WORDS; ++i)
            scene.texel_words.push_back(float_to_bits(float(srgb(i))));
        scene.texel_words.push_back(0xdeadbeefu); // so that a forgotten first_word shows
        Texture texture{};
        texture.first_word = u32(scene.texel_words.size());
        texture.width = width;
        texture.height = height;
        texture.format = format;
        texture.scale_u = texture.scale_v = texture.gain = 1;
        scene.textures.push_back(texture);
    }
    Texture& use() { return scene.textures[0]; }
    void add_bytes(u32 r, u32 g, u32 b, u32 a) {
        scene.texel_words.push_back(r | g << 8 | b << 16 | a << 24);
    }
    void add_floats(const Texel& texel) {
        for (const double value : texel)
            scene.texel_words.push_back(float_to_bits(float(value)));
    }
    Texel texel(int x, int y) const {
        const Texture& t = scene.textures[0];
        const size_t index = size_t(y) * t.width + size_t(x);
        if (t.format == TEXEL_FLOAT) {
            const u32* words = &scene.texel_words[t.first_word + 4 * index];
            return {bits_to_float(words[0]), bits_to_float(words[1]), bits_to_float(words[2]),
                    bits_to_float(words[3])};
        }
        const u32 word = scene.texel_words[t.first_word + index];
        const auto byte = [&](int k) { return word >> (8 * k) & 255u; };
        const auto color = [&](int k) { return t.format == TEXEL_SRGB8 ? srgb(byte(k)) : byte(k) / 255.0; };
        return {color(0), color(1), color(2), byte(3) / 255.0};
    }
    SceneProbe::Outputs lookup(const std::vector<vec4>& uv) const {
        return probe().run("lookup", scene, RenderParams{}, uv);
    }
};

/// A picture of random texels.
Picture random_picture(u32 width, u32 height, u32 format) {
    Picture picture(width, height, format);
    Random random(width + 1000 * height);
    for (u32 i = 0; i < width * height; ++i)
        if (format == TEXEL_FLOAT)
            picture.add_floats({random.between(-1, 1), random.between(0, 1e4), random.unit(), random.unit()});
        else
            picture.scene.texel_words.push_back(random.word());
    return picture;
}

/// The bilinear lookup in double. Texel (0, 0) is top left, uv (0, 0) the lower left corner.
Texel reference_lookup(const Picture& picture, const vec4& uv) {
    const Texture& t = picture.scene.textures[0];
    const double u = double(uv.x) * t.scale_u + double(uv.y) * t.shear_u + t.offset_u,
                 v = double(uv.x) * t.shear_v + double(uv.y) * t.scale_v + t.offset_v;
    const auto is_outside = [](double at, u32 wrap) { return wrap == WRAP_BLACK && (at < 0 || at > 1); };
    if (is_outside(u, t.wrap_u) || is_outside(v, t.wrap_v))
        return {0, 0, 0, 0};
    // The plane is tiled with the picture, each wrap in its own way; texels are counted through all tiles.
    const double x = u * t.width - 0.5, y = (1 - v) * t.height - 0.5;
    const auto place = [&](double at, u32 size, u32 wrap) {
        const int n = int(size), i = int(at), in_pair = (i % (2 * n) + 2 * n) % (2 * n);
        return wrap == WRAP_REPEAT   ? in_pair % n
               : wrap == WRAP_MIRROR ? std::min(in_pair, 2 * n - 1 - in_pair)
                                     : std::clamp(i, 0, n - 1);
    };
    Texel sum{};
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const double fx = x - std::floor(x), fy = y - std::floor(y);
            const double weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
            const Texel texel = picture.texel(place(std::floor(x) + dx, t.width, t.wrap_u),
                                              place(std::floor(y) + dy, t.height, t.wrap_v));
            for (size_t k = 0; k < 4; ++k)
                sum[k] += weight * texel[k];
        }
    for (double& value : sum)
        value = t.base + t.gain * value;
    return sum;
}

/// The centre of a texel as uv.
vec4 centre(const Texture& texture, u32 x, u32 y) {
    return {float((x + 0.5) / texture.width), float(1 - (y + 0.5) / texture.height), 0, 0};
}

/// Compares lookups with the reference. uv is known to u, which moves the picture by size u texels.
void expect_reference(const Picture& picture, const std::vector<vec4>& uv, double largest_uv) {
    const Texture& t = picture.scene.textures[0];
    const double step = t.format == TEXEL_FLOAT ? 2e4 : 1;
    const double tolerance = 4 * FLOAT_U * step * (4 + std::max(t.width, t.height) * (largest_uv + 1));
    const std::vector<vec4> got = picture.lookup(uv).first;
    for (size_t i = 0; i < uv.size(); ++i) {
        const Texel exact = reference_lookup(picture, uv[i]);
        const float values[] = {got[i].x, got[i].y, got[i].z, got[i].w};
        for (size_t k = 0; k < 4; ++k)
            ASSERT_NEAR(values[k], exact[k], tolerance)
                << "uv " << uv[i].x << " " << uv[i].y << " channel " << k;
    }
}

std::vector<vec4> random_uvs(size_t count, double low, double high) {
    Random random(7);
    std::vector<vec4> uvs;
    for (size_t i = 0; i < count; ++i) {
        const double u = random.between(low, high);
        uvs.push_back(to_vec4({u, random.between(low, high), 0}));
    }
    return uvs;
}

} // namespace

TEST(Texture, EveryByteIsDecodedByItsFormat) {
    for (const u32 format : {TEXEL_SRGB8, TEXEL_LINEAR8}) {
        Picture picture(256, 1, format);
        std::vector<vec4> uv;
        for (u32 i = 0; i < 256; ++i) {
            picture.add_bytes(i, 255 - i, i ^ 0x55u, i ^ 0xaau);
            uv.push_back(centre(picture.use(), i, 0));
        }
        const std::vector<vec4> got = picture.lookup(uv).first;
        for (u32 i = 0; i < 256; ++i) {
            const Texel exact = picture.texel(int(i), 0);
            EXPECT_NEAR(got[i].x, exact[0], 1e-6);
            EXPECT_NEAR(got[i].y, exact[1], 1e-6);
            EXPECT_NEAR(got[i].z, exact[2], 1e-6);
            EXPECT_NEAR(got[i].w, (i ^ 0xaau) / 255.0, 1e-6); // alpha is linear in both
        }
    }
}

TEST(Texture, FloatTexelsAreReadExactlyAtTheirCentres) {
    const Picture picture = random_picture(8, 4, TEXEL_FLOAT);
    std::vector<vec4> uv;
    for (u32 y = 0; y < 4; ++y)
        for (u32 x = 0; x < 8; ++x)
            uv.push_back(centre(picture.scene.textures[0], x, y));
    const std::vector<vec4> got = picture.lookup(uv).first;
    for (u32 i = 0; i < 32; ++i) {
        const Texel exact = picture.texel(int(i % 8), int(i / 8));
        EXPECT_TRUE(got[i].x == exact[0] && got[i].y == exact[1] && got[i].z == exact[2] &&
                    got[i].w == exact[3])
            << i;
    }
}

TEST(Texture, TheTopRowOfThePictureIsAtVOne) {
    Picture picture(2, 2, TEXEL_FLOAT);
    picture.add_floats({1, 0, 0, 1}); // top left, top right, bottom left, bottom right
    picture.add_floats({2, 0, 0, 1});
    picture.add_floats({3, 0, 0, 1});
    picture.add_floats({4, 0, 0, 1});
    const std::vector<vec4> got =
        picture
            .lookup({{0.25f, 0.75f, 0, 0}, {0.75f, 0.75f, 0, 0}, {0.25f, 0.25f, 0, 0}, {0.75f, 0.25f, 0, 0}})
            .first;
    EXPECT_EQ(got[0].x, 1);
    EXPECT_EQ(got[1].x, 2);
    EXPECT_EQ(got[2].x, 3);
    EXPECT_EQ(got[3].x, 4);
}

TEST(Texture, LookupsAreBilinearAndWrapAround) {
    for (const u32 format : {TEXEL_SRGB8, TEXEL_LINEAR8, TEXEL_FLOAT})
        for (const auto& [width, height] :
             {std::pair{7u, 5u}, std::pair{1u, 1u}, std::pair{64u, 3u}, std::pair{1u, 9u}}) {
            const Picture picture = random_picture(width, height, format);
            expect_reference(picture, random_uvs(5000, 0, 1), 1);
            expect_reference(picture, random_uvs(5000, -20, 20), 20);
            // The borders themselves.
            expect_reference(
                picture, {{0, 0, 0, 0}, {1, 1, 0, 0}, {0, 1, 0, 0}, {-1, 2, 0, 0}, {0.5f, 0.5f, 0, 0}}, 2);
        }
}

TEST(Texture, ClampedLookupsRepeatTheEdgeInsideAndAreBlackOutside) {
    for (const u32 format : {TEXEL_SRGB8, TEXEL_FLOAT}) {
        Picture picture = random_picture(6, 4, format);
        picture.use().wrap_u = picture.use().wrap_v = WRAP_BLACK;
        expect_reference(picture, random_uvs(5000, 0, 1), 1);
        expect_reference(picture, {{0, 0, 0, 0}, {1, 1, 0, 0}, {1, 0, 0, 0}, {0.01f, 0.99f, 0, 0}}, 1);
        picture.use().base = 0.5f; // outside there is no picture that could be shifted
        for (const vec4& outside : picture
                                       .lookup({{-1e-6f, 0.5f, 0, 0},
                                                {1.000001f, 0.5f, 0, 0},
                                                {0.5f, -3, 0, 0},
                                                {0.5f, 77, 0, 0},
                                                {std::numeric_limits<float>::quiet_NaN(), 0.5f, 0, 0}})
                                       .first)
            EXPECT_TRUE(outside.x == 0 && outside.y == 0 && outside.z == 0 && outside.w == 0);
    }
}

TEST(Texture, EachAxisWrapsInItsOwnWay) {
    for (const u32 wrap_u : {WRAP_REPEAT, WRAP_EDGE, WRAP_MIRROR})
        for (const u32 wrap_v : {WRAP_REPEAT, WRAP_EDGE, WRAP_MIRROR})
            for (const auto& [width, height] : {std::pair{7u, 5u}, std::pair{1u, 1u}, std::pair{2u, 9u}}) {
                Picture picture = random_picture(width, height, TEXEL_LINEAR8);
                picture.use().wrap_u = wrap_u;
                picture.use().wrap_v = wrap_v;
                expect_reference(picture, random_uvs(5000, -5, 5), 5);
                expect_reference(picture, {{0, 0, 0, 0}, {1, 1, 0, 0}, {-1, 2, 0, 0}, {3, -3, 0, 0}}, 3);
            }
}

TEST(Texture, ALookupThatIsNotFiniteReadsATexelOfThePicture) {
    const float odd[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                         -3e38f};
    for (const u32 wrap : {WRAP_REPEAT, WRAP_EDGE, WRAP_MIRROR}) {
        Picture picture = random_picture(4, 4, TEXEL_LINEAR8);
        picture.use().wrap_u = picture.use().wrap_v = wrap;
        for (const float u : odd)
            for (const vec4& got : picture.lookup({{u, 0.5f, 0, 0}, {0.5f, u, 0, 0}}).first)
                EXPECT_TRUE(got.x >= 0 && got.x <= 1) << wrap << " " << u;
    }
}

TEST(Texture, ATransformMayTurnThePicture) {
    Picture picture = random_picture(5, 7, TEXEL_LINEAR8);
    picture.use().scale_u = 0.8f;
    picture.use().scale_v = 1.6f;
    picture.use().shear_u = -1.2f;
    picture.use().shear_v = 0.6f;
    picture.use().offset_u = 0.3f;
    expect_reference(picture, random_uvs(5000, -2, 2), 6);
}

TEST(Texture, ScaleAndOffsetMoveTheLookupAndBaseAndGainTheValue) {
    Picture picture = random_picture(5, 7, TEXEL_LINEAR8);
    picture.use().scale_u = 2.5f;
    picture.use().scale_v = -1.5f;
    picture.use().offset_u = 0.3f;
    picture.use().offset_v = -0.7f;
    picture.use().base = 0.25f;
    picture.use().gain = 0.5f;
    expect_reference(picture, random_uvs(5000, -2, 2), 6);
    picture.use().wrap_u = picture.use().wrap_v = WRAP_BLACK;
    picture.use().scale_v = 1;
    picture.use().offset_v = 0;
    expect_reference(picture, {{0.1f, 0.5f, 0, 0}, {0.2f, 0.1f, 0, 0}, {-0.1f, 0.9f, 0, 0}}, 1);
}

TEST(Texture, ScalarMapsReadTheirChannel) {
    Picture picture(1, 1, TEXEL_FLOAT);
    picture.add_floats({0.1, 0.2, 0.4, 0.8});
    const double expected[] = {0.1, 0.2, 0.4, 0.8, 0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.4};
    for (u32 channel = 0; channel <= LUMINANCE; ++channel) {
        picture.use().channel = channel;
        EXPECT_NEAR(picture.lookup({{0.3f, 0.9f, 0, 0}}).third[0].x, expected[channel], 1e-7) << channel;
    }
}

TEST(Texture, AlphaMultipliesColoursWhereItIsAskedTo) {
    Picture picture(1, 1, TEXEL_FLOAT);
    picture.add_floats({0.25, 0.5, 2, 0.75});
    const struct {
        u32 flags;
        double r, g, b;
    } cases[] = {{0, 0.25, 0.5, 2},
                 {TEXTURE_TIMES_ALPHA, 0.1875, 0.375, 1.5},
                 {TEXTURE_TIMES_ALPHA | TEXTURE_WHITE, 0.75, 0.75, 0.75}};
    for (const auto& [flags, r, g, b] : cases) {
        picture.use().channel = flags;
        const vec4 got = picture.lookup({{0.5f, 0.5f, 0, 0}}).second[0];
        EXPECT_EQ(got.x, r);
        EXPECT_EQ(got.y, g);
        EXPECT_EQ(got.z, b);
    }
}

TEST(Texture, ColoursAreNeverNegative) {
    Picture picture(1, 1, TEXEL_FLOAT);
    picture.add_floats({-0.5, 0.25, 2, 1});
    const SceneProbe::Outputs got = picture.lookup({{0.5f, 0.5f, 0, 0}});
    EXPECT_EQ(got.first[0].x, -0.5f); // data may be
    EXPECT_EQ(got.second[0].x, 0);
    EXPECT_EQ(got.second[0].y, 0.25f);
    EXPECT_EQ(got.second[0].z, 2);
}

TEST(Texture, CoordinatesOfAnySizeReadSomeTexel) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const Picture picture = random_picture(13, 11, TEXEL_LINEAR8);
    std::vector<vec4> uv;
    for (const float u : {0.0f, -0.0f, -1e-9f, 1e-30f, 1e9f, -1e9f, 1e30f, 3e38f, -3e38f, inf, -inf, nan})
        for (const float v : {0.5f, -1e-9f, 1e30f, inf, nan})
            uv.push_back({u, v, 0, 0});
    for (const vec4& value : picture.lookup(uv).first)
        EXPECT_TRUE(value.x >= 0 && value.x <= 1 && value.w >= 0 && value.w <= 1);
}

namespace {

/// The same picture as if level k were all there is.
Picture level_alone(const Picture& picture, u32 k) {
    Picture level = picture;
    Texture& t = level.use();
    for (; k > 0 && t.width * t.height > 1; --k) {
        t.first_word += u32(texel_words(t.format, size_t(t.width) * t.height));
        t.width = std::max(t.width / 2, 1u);
        t.height = std::max(t.height / 2, 1u);
    }
    return level;
}

/// uv with the area of a footprint of so many texels.
std::vector<vec4> with_footprint(std::vector<vec4> uv, const Picture& picture, double texels) {
    const Texture& t = picture.scene.textures[0];
    for (vec4& at : uv)
        at.z = float(texels / (double(t.width) * t.height));
    return uv;
}

std::vector<vec4> random_uv(size_t count) {
    Random random(9);
    std::vector<vec4> uv;
    for (size_t i = 0; i < count; ++i)
        uv.push_back({float(random.between(-2, 2)), float(random.between(-2, 2)), 0, 0});
    return uv;
}

bool same_values(const vec4& a, const vec4& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

} // namespace

TEST(TextureFilter, AFootprintBelowATexelReadsThePictureItself) {
    for (const u32 format : {TEXEL_SRGB8, TEXEL_FLOAT, TEXEL_GREY_SRGB8}) {
        Picture picture = random_picture(16, 8, format);
        append_levels(format, 16, 8, picture.scene.texel_words);
        const std::vector<vec4> uv = random_uv(500);
        const std::vector<vec4> point = picture.lookup(uv).first,
                                filtered = picture.lookup(with_footprint(uv, picture, 0.99)).first;
        for (size_t i = 0; i < uv.size(); ++i)
            EXPECT_TRUE(same_values(point[i], filtered[i])) << format << ": " << i;
    }
}

TEST(TextureFilter, AFootprintOfFourToTheKReadsLevelK) {
    for (const u32 format : {TEXEL_SRGB8, TEXEL_LINEAR8, TEXEL_FLOAT, TEXEL_GREY_SRGB8, TEXEL_GREY_LINEAR8}) {
        Picture picture = random_picture(16, 8, format);
        append_levels(format, 16, 8, picture.scene.texel_words);
        const std::vector<vec4> uv = random_uv(200);
        for (const u32 k : {1u, 2u, 3u, 4u, 7u}) {
            const std::vector<vec4> filtered =
                picture.lookup(with_footprint(uv, picture, std::ldexp(1.0, 2 * int(k)))).first;
            const std::vector<vec4> level = level_alone(picture, k).lookup(uv).first;
            for (size_t i = 0; i < uv.size(); ++i)
                EXPECT_TRUE(same_values(level[i], filtered[i])) << format << ", level " << k << ": " << i;
        }
    }
}

TEST(TextureFilter, LevelsAreMixedInBetweenWithoutAStep) {
    Picture picture = random_picture(32, 32, TEXEL_FLOAT);
    append_levels(TEXEL_FLOAT, 32, 32, picture.scene.texel_words);
    const std::vector<vec4> uv = random_uv(200);
    const std::vector<vec4> low = level_alone(picture, 1).lookup(uv).first,
                            high = level_alone(picture, 2).lookup(uv).first;
    // log2 is taken as linear between powers of two: of 6 texels it is 2 + 1/2 for 2.585.
    const std::vector<vec4> got = picture.lookup(with_footprint(uv, picture, 6)).first;
    for (size_t i = 0; i < uv.size(); ++i)
        EXPECT_NEAR(got[i].y, low[i].y + 0.25 * (high[i].y - low[i].y), 1e-2) << i;
}

TEST(TextureFilter, AnEvenPictureHasOneColourAtAnyFootprint) {
    Picture picture(13, 6, TEXEL_SRGB8);
    for (int i = 0; i < 13 * 6; ++i)
        picture.add_bytes(10, 100, 200, 255);
    append_levels(TEXEL_SRGB8, 13, 6, picture.scene.texel_words);
    const std::vector<vec4> uv = random_uv(100);
    const vec4 expected = picture.lookup(uv).first[0];
    for (const double texels : {0.0, 1.5, 7.0, 60.0, 1e4, 1e30})
        for (const vec4& got : picture.lookup(with_footprint(uv, picture, texels)).first)
            EXPECT_TRUE(same_values(got, expected)) << texels;
}

TEST(Texture, ATextureReadsItsPairOfCoordinatesAndItsFootprint) {
    Picture picture = random_picture(8, 4, TEXEL_SRGB8);
    append_levels(TEXEL_SRGB8, 8, 4, picture.scene.texel_words);
    const std::vector<vec4> first = {{0.3f, 0.7f, 0, 0}}, second = {{0.6f, 0.2f, 0, 0}},
                            pairs = {{0.3f, 0.7f, 0.6f, 0.2f}};
    for (const float area : {0.f, 0.5f}) {
        const auto look_at = [&](vec4 uv) {
            uv.z = area;
            return picture.lookup({uv}).first[0].x;
        };
        const auto look_at_pairs = [&](const vec4& areas) {
            return probe().run("pairs", picture.scene, RenderParams{}, pairs, {areas}).first[0].x;
        };
        picture.use().channel = LUMINANCE;
        const float grey = picture.lookup(second).third[0].x;
        EXPECT_EQ(look_at_pairs({area, 9, 0, 0}), look_at(first[0]));
        picture.use().channel = LUMINANCE | TEXTURE_SECOND_UV;
        EXPECT_EQ(look_at_pairs({9, area, 0, 0}), look_at(second[0]));
        EXPECT_EQ(picture.lookup(second).third[0].x, grey) << "the channel is that without the flag";
    }
}

TEST(TextureLookup, GreyBytesAreColoursOfEqualChannels) {
    for (const bool is_srgb : {true, false}) {
        Picture colour(7, 3, is_srgb ? TEXEL_SRGB8 : TEXEL_LINEAR8),
            grey(7, 3, is_srgb ? TEXEL_GREY_SRGB8 : TEXEL_GREY_LINEAR8);
        Random random(4);
        std::vector<u32> bytes;
        for (int i = 0; i < 21; ++i) {
            bytes.push_back(random.word() & 255u);
            colour.add_bytes(bytes.back(), bytes.back(), bytes.back(), 255);
        }
        for (size_t i = 0; i < 24; i += 4) {
            u32 word = 0;
            for (size_t k = 0; k < 4 && i + k < bytes.size(); ++k)
                word |= bytes[i + k] << (8 * k);
            grey.scene.texel_words.push_back(word);
        }
        const std::vector<vec4> uv = random_uv(300);
        const std::vector<vec4> a = colour.lookup(uv).first, b = grey.lookup(uv).first;
        for (size_t i = 0; i < uv.size(); ++i)
            EXPECT_TRUE(same_values(a[i], b[i])) << i;
    }
}
