// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_store.h"

#include "colour.h"
#include "error.h"
#include "scene/read_image.h"
#include "scene_support.h"

#include <array>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

using Bytes = std::vector<std::uint8_t>;

class TextureStoreTest : public testing::Test {
protected:
    /// Adds a use of a file beside the (imaginary) material library.
    u32 add(const std::string& file, TextureRole role, TextureUse use = {}) {
        use.file = file;
        use.place = {folder.path("scene.mtl"), 5};
        return store.add(use, role, notices);
    }
    const Texture& texture(u32 index) const { return store.textures().at(index); }

    TemporaryFolder folder;
    TextureStore store;
    NoticeList notices;
};

void expect_texel(const vec4& texel, double r, double g, double b, double a) {
    EXPECT_NEAR(texel.x, r, 1e-6);
    EXPECT_NEAR(texel.y, g, 1e-6);
    EXPECT_NEAR(texel.z, b, 1e-6);
    EXPECT_NEAR(texel.w, a, 1e-6);
}

} // namespace

TEST_F(TextureStoreTest, TheFirstWordsAreTheSrgbCurve) {
    ASSERT_EQ(store.words().size(), 256u);
    for (u32 i = 0; i < 256; ++i) {
        float value;
        std::memcpy(&value, &store.words()[i], sizeof value);
        const double v = i / 255.0;
        const double exact = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        EXPECT_EQ(value, float(exact)) << i;
    }
}

TEST_F(TextureStoreTest, ColoursAreSrgbAndDataLinear) {
    folder.write_image("a.png", 2, 1, 3, Bytes{255, 128, 0, 1, 2, 3}, OIIO::TypeDesc::UINT8);
    const u32 colour = add("a.png", TextureRole::COLOUR), data = add("a.png", TextureRole::NORMAL);
    EXPECT_EQ(texture(colour).format, TEXEL_SRGB8);
    EXPECT_EQ(texture(data).format, TEXEL_LINEAR8);
    EXPECT_EQ(texture(colour).first_word, 256u);
    EXPECT_EQ(store.words()[256], 255u | 128u << 8 | 0u << 16 | 255u << 24);
    expect_texel(store.texel(texture(colour), 0, 0), 1, srgb_to_linear(128 / 255.), 0, 1);
    expect_texel(store.texel(texture(data), 0, 0), 1, 128 / 255., 0, 1);
}

TEST_F(TextureStoreTest, RowsRunFromTheTop) {
    folder.write_image("a.png", 1, 3, 1, Bytes{10, 20, 30}, OIIO::TypeDesc::UINT8);
    folder.write_image("a.tga", 1, 3, 3, Bytes{10, 0, 0, 20, 0, 0, 30, 0, 0}, OIIO::TypeDesc::UINT8);
    for (const char* name : {"a.png", "a.tga"}) {
        const Texture t = texture(add(name, TextureRole::SCALAR));
        EXPECT_NEAR(store.texel(t, 0, 0).x, 10 / 255., 1e-6) << name;
        EXPECT_NEAR(store.texel(t, 0, 2).x, 30 / 255., 1e-6) << name;
        EXPECT_EQ(t.height, 3u);
    }
}

TEST_F(TextureStoreTest, AllChannelCountsBecomeRgba) {
    folder.write_image("1.png", 1, 1, 1, Bytes{51}, OIIO::TypeDesc::UINT8);
    folder.write_image("2.png", 1, 1, 2, Bytes{51, 102}, OIIO::TypeDesc::UINT8);
    folder.write_image("4.png", 1, 1, 4, Bytes{51, 102, 153, 0}, OIIO::TypeDesc::UINT8);
    expect_texel(store.texel(texture(add("1.png", TextureRole::SCALAR)), 0, 0), 0.2, 0.2, 0.2, 1);
    expect_texel(store.texel(texture(add("2.png", TextureRole::SCALAR)), 0, 0), 0.2, 0.2, 0.2, 0.4);
    // Colours keep their value where alpha is 0: they are not multiplied by it.
    expect_texel(store.texel(texture(add("4.png", TextureRole::NORMAL)), 0, 0), 0.2, 0.4, 0.6, 0);
}

TEST_F(TextureStoreTest, FloatsStayLinearAndSixteenBitColoursAreDecoded) {
    folder.write_image("a.exr", 1, 1, 3, std::vector<float>{2.5f, 0.5f, 1e-3f}, OIIO::TypeDesc::FLOAT);
    folder.write_image("a.hdr", 1, 1, 3, std::vector<float>{4, 0.5f, 0.25f}, OIIO::TypeDesc::FLOAT);
    folder.write_image("a.png", 1, 1, 3, std::vector<std::uint16_t>{32768, 65535, 0}, OIIO::TypeDesc::UINT16);
    const u32 exr = add("a.exr", TextureRole::COLOUR), hdr = add("a.hdr", TextureRole::COLOUR);
    EXPECT_EQ(texture(exr).format, TEXEL_FLOAT);
    expect_texel(store.texel(texture(exr), 0, 0), 2.5, 0.5, 1e-3, 1);
    expect_texel(store.texel(texture(hdr), 0, 0), 4, 0.5, 0.25, 1);
    const u32 colour = add("a.png", TextureRole::COLOUR), data = add("a.png", TextureRole::SCALAR);
    EXPECT_EQ(texture(colour).format, TEXEL_FLOAT);
    expect_texel(store.texel(texture(colour), 0, 0), srgb_to_linear(32768 / 65535.), 1, 0, 1);
    expect_texel(store.texel(texture(data), 0, 0), 32768 / 65535., 1, 0, 1);
}

TEST_F(TextureStoreTest, AFileIsStoredOnceForEachEncoding) {
    folder.write_image("a.png", 4, 4, 3, Bytes(48, 7), OIIO::TypeDesc::UINT8);
    TextureUse scaled;
    scaled.scale = {2, 3};
    scaled.offset = {0.5, 0.25};
    scaled.base = 0.1;
    scaled.gain = 0.8;
    scaled.shear = {-1, 4};
    scaled.wrap_u = TextureWrap::BLACK;
    scaled.wrap_v = TextureWrap::MIRROR;
    const u32 plain = add("a.png", TextureRole::COLOUR), other = add("a.png", TextureRole::COLOUR, scaled);
    EXPECT_NE(plain, other);
    EXPECT_EQ(texture(plain).first_word, texture(other).first_word);
    EXPECT_EQ(store.words().size(), 256u + 16);
    add("a.png", TextureRole::SCALAR);
    EXPECT_EQ(store.words().size(), 256u + 32);
    const Texture& t = texture(other);
    EXPECT_EQ(t.scale_u, 2);
    EXPECT_EQ(t.scale_v, 3);
    EXPECT_EQ(t.offset_u, 0.5f);
    EXPECT_EQ(t.offset_v, 0.25f);
    EXPECT_EQ(t.base, 0.1f);
    EXPECT_EQ(t.gain, 0.8f);
    EXPECT_EQ(t.shear_u, -1);
    EXPECT_EQ(t.shear_v, 4);
    EXPECT_EQ(t.wrap_u, WRAP_BLACK);
    EXPECT_EQ(t.wrap_v, WRAP_MIRROR);
    EXPECT_EQ(texture(plain).wrap_u, WRAP_REPEAT);
    EXPECT_EQ(texture(plain).gain, 1);
}

TEST_F(TextureStoreTest, CoverageIsAlphaWhereThereIsOne) {
    folder.write_image("rgba.png", 1, 1, 4, Bytes(4, 9), OIIO::TypeDesc::UINT8);
    folder.write_image("rgb.png", 1, 1, 3, Bytes(3, 9), OIIO::TypeDesc::UINT8);
    folder.write_image("grey.png", 1, 1, 1, Bytes(1, 9), OIIO::TypeDesc::UINT8);
    folder.write_image("grey_alpha.png", 1, 1, 2, Bytes(2, 9), OIIO::TypeDesc::UINT8);
    EXPECT_EQ(texture(add("rgba.png", TextureRole::COVERAGE)).channel, 3u);
    EXPECT_EQ(texture(add("grey_alpha.png", TextureRole::COVERAGE)).channel, 3u);
    EXPECT_EQ(texture(add("rgb.png", TextureRole::COVERAGE)).channel, 4u);
    EXPECT_EQ(texture(add("grey.png", TextureRole::COVERAGE)).channel, 0u);
    EXPECT_EQ(texture(add("rgba.png", TextureRole::SCALAR)).channel, 4u);
    EXPECT_EQ(texture(add("grey.png", TextureRole::SCALAR)).channel, 0u);
    TextureUse red;
    red.channel = 0;
    EXPECT_EQ(texture(add("rgba.png", TextureRole::COVERAGE, red)).channel, 0u);
}

TEST_F(TextureStoreTest, AMaskSharesTheTexelsOfTheColoursBesideIt) {
    folder.write_image("leaf.png", 2, 2, 4, Bytes(16, 100), OIIO::TypeDesc::UINT8);
    const u32 colour = add("leaf.png", TextureRole::COLOUR), mask = add("leaf.png", TextureRole::COVERAGE);
    EXPECT_EQ(texture(mask).first_word, texture(colour).first_word);
    EXPECT_NEAR(store.texel(texture(mask), 1, 1).w, 100 / 255., 1e-6) << "alpha is linear in both encodings";
}

TEST_F(TextureStoreTest, MissingAndBrokenFilesAreOneNoticeEach) {
    folder.write("broken.png", "this is no picture");
    folder.write("empty.jpg", "");
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(add("none.png", TextureRole::COLOUR), NO_INDEX);
        EXPECT_EQ(add("broken.png", TextureRole::COLOUR), NO_INDEX);
        EXPECT_EQ(add("empty.jpg", TextureRole::COLOUR), NO_INDEX);
    }
    EXPECT_EQ(notices.lines().size(), 3u);
    EXPECT_EQ(
        count_notices(notices, "scene.mtl:5: no file 'none.png' found, the map is ignored (and 1 more)"), 1);
    EXPECT_EQ(count_notices(notices, "broken.png"), 1);
    EXPECT_TRUE(store.textures().empty());
}

TEST_F(TextureStoreTest, ATruncatedPictureIsNotUsed) {
    std::vector<std::uint8_t> noise(64 * 64 * 3);
    unsigned state = 1;
    for (std::uint8_t& byte : noise)
        byte = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
    const std::string path = folder.write_image("cut.png", 64, 64, 3, noise, OIIO::TypeDesc::UINT8);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_EQ(add("cut.png", TextureRole::COLOUR), NO_INDEX);
    EXPECT_EQ(count_notices(notices, "the map is ignored"), 1);
}

TEST_F(TextureStoreTest, PicturesOfSeveralBlocksArriveWholeInTilesAndWithAnOffset) {
    constexpr int WIDTH = 70, HEIGHT = 201; // no multiple of a block or a tile
    std::vector<float> values;
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
        values.push_back(float(i));
    for (const bool tiled : {false, true})
        for (const char* name : {"a.exr", "a.tif"}) {
            SCOPED_TRACE(std::string(name) + (tiled ? " in tiles" : ""));
            OIIO::ImageSpec spec(WIDTH, HEIGHT, 1, OIIO::TypeDesc::FLOAT);
            spec.x = 5;
            spec.y = 7;
            spec.tile_width = spec.tile_height = tiled ? 64 : 0;
            const std::string path = folder.path((tiled ? "tiled_" : "") + std::string(name));
            const auto output = OIIO::ImageOutput::create(path);
            ASSERT_TRUE(output && output->open(path, spec));
            ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
            const FloatImage image = read_float_image(path, ImageEncoding::DATA);
            ASSERT_EQ(image.rgba.size(), values.size());
            for (size_t i = 0; i < values.size(); ++i)
                ASSERT_EQ(image.rgba[i].x, values[i]) << i;
        }
}

TEST_F(TextureStoreTest, AFileThatVanishesBetweenTwoUsesIsANotice) {
    const std::string path = folder.write_image("a.png", 1, 1, 3, Bytes{9, 9, 9}, OIIO::TypeDesc::UINT8);
    EXPECT_NE(add("a.png", TextureRole::COLOUR), NO_INDEX);
    std::filesystem::remove(path);
    EXPECT_EQ(add("a.png", TextureRole::NORMAL), NO_INDEX);
    folder.write("a.png", "now another kind of file");
    EXPECT_EQ(add("a.png", TextureRole::NORMAL), NO_INDEX);
    EXPECT_EQ(count_notices(notices, "a.png"), 2);
    EXPECT_EQ(store.texel(texture(0), 0, 0).w, 1) << "what was read stays";
}

TEST_F(TextureStoreTest, WhyAPictureCannotBeOpenedIsSaid) {
    const auto refused = [&](const std::string& name) {
        try {
            read_image(folder.path(name), ImageEncoding::COLOUR);
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refused("missing.hdr"),
              folder.path("missing.hdr") + ": the picture cannot be opened: No such file or directory");
    folder.write("text.hdr", "no picture at all");
    EXPECT_NE(refused("text.hdr"), "");
    EXPECT_EQ(refused("text.hdr").find("No such file"), std::string::npos);
}

TEST_F(TextureStoreTest, PathsOfOtherSystemsAreFound) {
    std::filesystem::create_directories(folder.path("images"));
    folder.write_image("images/a b.png", 1, 1, 1, Bytes{1}, OIIO::TypeDesc::UINT8);
    folder.write_image("c.png", 1, 1, 1, Bytes{1}, OIIO::TypeDesc::UINT8);
    EXPECT_NE(add(".\\images\\a b.png", TextureRole::COLOUR), NO_INDEX);
    EXPECT_NE(add("D:\\work\\c.png", TextureRole::COLOUR), NO_INDEX);
}

TEST_F(TextureStoreTest, NonFiniteTexelsBecomeZero) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    folder.write_image("a.exr", 1, 1, 3, std::vector<float>{nan, infinity, 0.5f}, OIIO::TypeDesc::FLOAT);
    expect_texel(store.texel(texture(add("a.exr", TextureRole::COLOUR)), 0, 0), 0, 0, 0.5, 1);
    EXPECT_EQ(count_notices(notices, "2 values are NaN or infinite"), 1);
}

TEST_F(TextureStoreTest, MeanIsLinearWithBaseAndGain) {
    folder.write_image("a.exr", 2, 1, 3, std::vector<float>{1, 2, 3, 3, 0, 1}, OIIO::TypeDesc::FLOAT);
    folder.write_image("a.png", 2, 1, 1, Bytes{0, 188}, OIIO::TypeDesc::UINT8);
    EXPECT_EQ(store.mean(add("a.exr", TextureRole::COLOUR)), glm::dvec3(2, 1, 2));
    EXPECT_NEAR(store.mean(add("a.png", TextureRole::COLOUR)).x, srgb_to_linear(188 / 255.) / 2, 1e-6);
    TextureUse use;
    use.base = -1;
    use.gain = 2;
    const glm::dvec3 mean = store.mean(add("a.exr", TextureRole::COLOUR, use));
    EXPECT_NEAR(mean.y, 1.5, 1e-6) << "2 * 2 - 1 and 0 (not below) on average";
    EXPECT_EQ(store.largest(add("a.exr", TextureRole::COLOUR)), glm::dvec3(3, 2, 3));
    EXPECT_EQ(store.largest(add("a.exr", TextureRole::COLOUR, use)), glm::dvec3(5, 3, 5));
    use.gain = -2;
    use.base = 3;
    EXPECT_EQ(store.largest(add("a.exr", TextureRole::COLOUR, use)), glm::dvec3(1, 3, 1)) << "of the darkest";
}

namespace {

/// A picture of 10 x 10 texels (r, g, b) of which the first `odd` differ.
Bytes picture(const std::array<std::uint8_t, 3>& usual, const std::array<std::uint8_t, 3>& other, int odd) {
    Bytes bytes;
    for (int i = 0; i < 100; ++i)
        for (const std::uint8_t value : i < odd ? other : usual)
            bytes.push_back(value);
    return bytes;
}

} // namespace

TEST_F(TextureStoreTest, NormalMapsAreKnownByTheirTexels) {
    constexpr std::array<std::uint8_t, 3> UP{128, 128, 255}, TILTED{218, 128, 218}, GREY{128, 128, 128},
        BLUE{90, 120, 210}, SIDEWAYS{255, 128, 128};
    const auto is_normal = [&](const std::string& name, const Bytes& bytes, int channels = 3) {
        folder.write_image(name, 10, 10, channels, bytes, OIIO::TypeDesc::UINT8);
        TextureUse use;
        use.file = name;
        use.place = {folder.path("scene.mtl"), 5};
        return store.is_normal_map(use, notices);
    };
    EXPECT_TRUE(is_normal("flat.png", picture(UP, UP, 0)));
    EXPECT_TRUE(is_normal("tilted.png", picture(TILTED, UP, 40)));
    EXPECT_TRUE(is_normal("few_odd.png", picture(UP, GREY, 3)));
    EXPECT_FALSE(is_normal("more_odd.png", picture(UP, GREY, 4))) << "97 % are unit vectors";
    EXPECT_FALSE(is_normal("blue.png", picture(BLUE, BLUE, 0)));
    EXPECT_FALSE(is_normal("sideways.png", picture(SIDEWAYS, SIDEWAYS, 0))) << "unit vectors, far from +z";
    EXPECT_FALSE(is_normal("heights.png", picture(GREY, {200, 200, 200}, 50)));
    EXPECT_FALSE(is_normal("grey.png", Bytes(100, 202), 1)) << "(202, 202, 202) is near a unit vector";
    folder.write_image("floats.exr", 1, 1, 3, std::vector<float>{0.5f, 0.5f, 1}, OIIO::TypeDesc::FLOAT);
    TextureUse use;
    use.place = {folder.path("scene.mtl"), 5};
    use.file = "floats.exr";
    EXPECT_TRUE(store.is_normal_map(use, notices));
    use.file = "missing.png";
    EXPECT_FALSE(store.is_normal_map(use, notices));
    EXPECT_FALSE(store.is_readable(use, TextureRole::COLOUR, notices));
    EXPECT_TRUE(notices.lines().empty()) << "the use of the map says it";
}

TEST_F(TextureStoreTest, QuestionsReadAPictureOnceAndKeepItsNotices) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    folder.write_image("a.exr", 1, 1, 3, std::vector<float>{nan, 0.5f, 1}, OIIO::TypeDesc::FLOAT);
    TextureUse use;
    use.file = "a.exr";
    use.place = {folder.path("scene.mtl"), 5};
    EXPECT_FALSE(store.is_normal_map(use, notices));
    EXPECT_TRUE(store.is_readable(use, TextureRole::NORMAL, notices));
    const size_t words = store.words().size();
    add("a.exr", TextureRole::NORMAL);
    EXPECT_EQ(store.words().size(), words);
    EXPECT_EQ(count_notices(notices, "1 values are NaN or infinite"), 1);
}
