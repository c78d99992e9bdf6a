// SPDX-License-Identifier: Apache-2.0
// Pictures on disk: what is in them, and that they appear whole or not at all.
#include "output/image.h"

#include "error.h"
#include "output/atomic_file.h"
#include "output/tonemap.h"
#include "probes/scratch_folder.h"
#include "support/file_size_limit.h"

#include <cmath>
#include <csignal>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <OpenImageIO/imageio.h>
#include <sys/resource.h>
#include <unistd.h>

namespace clrt {

namespace {

const std::vector<std::string> EXTENSIONS = {"png", "jpg", "jpeg", "bmp", "tga", "ppm",
                                             "exr", "tif", "tiff", "hdr", "pfm"};
constexpr float INFINITE = std::numeric_limits<float>::infinity();
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

/// A whole picture without further layers whose values come from a fixed linear congruence, 0 to 1.
Picture noise(int width, int height) {
    Picture picture;
    picture.width = picture.full_width = width;
    picture.height = picture.full_height = height;
    Layer rgb{"", {"R", "G", "B"}, {}, false};
    std::uint32_t state = 1;
    for (int i = 0; i < 3 * width * height; ++i) {
        state = state * 1664525u + 1013904223u;
        rgb.values.push_back(static_cast<float>(state >> 8) / 16777216.0f);
    }
    picture.layers.push_back(rgb);
    return picture;
}

/// A layer whose value i is first + i.
Layer ramp(const std::string& name, const std::vector<std::string>& channels, int pixels, float first,
           bool is_id) {
    Layer layer{name, channels, {}, is_id};
    for (size_t i = 0; i < static_cast<size_t>(pixels) * channels.size(); ++i)
        layer.values.push_back(first + static_cast<float>(i));
    return layer;
}

/// All pixels of a file as type T, and its description.
template <typename T>
std::vector<T> read_pixels(const std::string& path, OIIO::ImageSpec& spec) {
    const auto input = OIIO::ImageInput::open(path);
    if (!input)
        throw std::runtime_error(OIIO::geterror());
    spec = input->spec();
    std::vector<T> pixels(static_cast<size_t>(spec.image_pixels()) * static_cast<size_t>(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDescFromC<T>::value(), pixels.data()))
        throw std::runtime_error(input->geterror());
    return pixels;
}

/// The linear value whose sRGB encoding is x (IEC 61966-2-1).
double srgb_decode(double x) {
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

std::uint8_t grey(double radiance, double factor = 1, Tonemap tonemap = Tonemap::NONE) {
    return display_colour(glm::dvec3(radiance), factor, tonemap)[0];
}

/// Whoever runs the test is not root in this scope.
class NotRoot {
public:
    NotRoot() : root_(geteuid() == 0) {
        if (root_ && seteuid(65534) != 0)
            throw std::runtime_error("cannot become an ordinary user");
    }
    ~NotRoot() {
        if (root_ && seteuid(0) != 0)
            std::abort();
    }

private:
    bool root_;
};

std::string write_error(const Picture& picture, const std::string& path) {
    try {
        write_picture(picture, path, 0, Tonemap::NONE);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "written";
}

} // namespace

TEST(Tonemap, SrgbCurveIsTheStandardOne) {
    EXPECT_EQ(srgb_encode(0), 0);
    EXPECT_NEAR(srgb_encode(1), 1, 1e-15);
    EXPECT_NEAR(srgb_encode(0.5), 0.7353569830524495, 1e-12);
    EXPECT_NEAR(srgb_encode(0.001), 0.01292, 1e-15);
    for (double x = 0; x <= 1; x += 1.0 / 1024)
        EXPECT_NEAR(srgb_encode(srgb_decode(x)), x, 1e-7);
}

TEST(Tonemap, BytesAreRoundedToTheNearest) {
    for (int byte = 0; byte < 256; ++byte) {
        EXPECT_EQ(grey(srgb_decode(byte / 255.0)), byte);
        EXPECT_EQ(grey(srgb_decode((byte + 0.499) / 255.0)), byte);
        EXPECT_EQ(grey(srgb_decode((byte + 0.501) / 255.0)), std::min(byte + 1, 255));
    }
}

TEST(Tonemap, ExposureIsInStopsAndWhiteClamps) {
    EXPECT_EQ(grey(0.25, 2), grey(0.5));
    EXPECT_EQ(grey(1), 255);
    EXPECT_EQ(grey(7), 255);
    EXPECT_EQ(grey(0), 0);
}

TEST(Tonemap, OddNumbersBecomeBlackOrWhite) {
    for (const Tonemap tonemap :
         {Tonemap::NONE, Tonemap::REINHARD, Tonemap::ACES, Tonemap::FILMIC, Tonemap::AGX}) {
        EXPECT_EQ(grey(NOT_A_NUMBER, 1, tonemap), 0);
        EXPECT_EQ(grey(-1, 1, tonemap), 0);
        EXPECT_EQ(grey(-INFINITE, 1, tonemap), 0);
        EXPECT_EQ(grey(INFINITE, 1, tonemap), 255);
        EXPECT_EQ(grey(std::numeric_limits<float>::max(), 1e30, tonemap), 255);
    }
}

TEST(Tonemap, ReinhardCompressesLuminanceAndKeepsHue) {
    EXPECT_NEAR(tonemap_curve(glm::dvec3(3), Tonemap::REINHARD).x, 0.75, 1e-12);
    const glm::dvec3 colour(0.2, 3, 1), mapped = tonemap_curve(colour, Tonemap::REINHARD);
    EXPECT_NEAR(mapped.x / mapped.y, colour.x / colour.y, 1e-12);
    EXPECT_NEAR(mapped.z / mapped.y, colour.z / colour.y, 1e-12);
    const double luminance = 0.2126 * 0.2 + 0.7152 * 3 + 0.0722;
    EXPECT_NEAR(0.2126 * mapped.x + 0.7152 * mapped.y + 0.0722 * mapped.z, luminance / (1 + luminance),
                1e-12);
}

TEST(Tonemap, AcesFitHasItsPublishedValuesAndRises) {
    EXPECT_EQ(tonemap_curve(glm::dvec3(0), Tonemap::ACES).x, 0);
    EXPECT_NEAR(tonemap_curve(glm::dvec3(1), Tonemap::ACES).y, 2.54 / 3.16, 1e-12);
    double before = -1;
    for (double x = 0; x < 100; x += 0.01) {
        const double now = tonemap_curve(glm::dvec3(x), Tonemap::ACES).z;
        EXPECT_GT(now, before);
        before = now;
    }
}

// The talk's quotient is 0.7251294 at its white of 11.2; the exposure bias is 2.
TEST(Tonemap, HablesCurveHasItsPublishedValuesAndRisesToItsWhite) {
    const auto curve = [](double x) { return tonemap_curve(glm::dvec3(x), Tonemap::FILMIC).y; };
    EXPECT_NEAR(curve(0), 0, 1e-15);
    EXPECT_NEAR(curve(0.18),
                (0.36 * 0.104 + 0.004) / (0.36 * 0.554 + 0.06) / 0.7251294 - 0.02 / 0.30 / 0.7251294, 1e-6);
    EXPECT_NEAR(curve(1), (2 * 0.35 + 0.004) / (2 * 0.8 + 0.06) / 0.7251294 - 0.02 / 0.30 / 0.7251294, 1e-6);
    EXPECT_NEAR(curve(5.6), 1, 1e-12);
    EXPECT_NEAR(curve(1e30), 1, 1e-12);
    for (double x = 0; x < 5.5; x += 0.01)
        EXPECT_LT(curve(x), curve(x + 0.01));
    // A shoulder: the brighter, the flatter.
    for (double x = 0.01; x < 3; x *= 1.5)
        EXPECT_GT(curve(x) / x, curve(1.5 * x) / (1.5 * x));
}

TEST(Output, KnownExtensionsAreAcceptedInAnyCase) {
    for (const std::string& extension : EXTENSIONS)
        EXPECT_NO_THROW(check_output_path("a/b c." + extension));
    EXPECT_NO_THROW(check_output_path("A.EXR"));
    for (const char* path : {"a.gif", "a", "", "png", ".png", "a.png.txt", "a.exr/"})
        EXPECT_THROW(check_output_path(path), UsageError) << path;
}

TEST(Output, ExrHoldsEveryLayerExactly) {
    ScratchFolder folder;
    Picture picture = noise(7, 70);
    picture.layers[0].values[0] = NOT_A_NUMBER;
    picture.layers[0].values[1] = -INFINITE;
    picture.layers[0].values[2] = 1e-42f;
    picture.layers.push_back(ramp("albedo", {"R", "G", "B"}, 490, 0.25f, false));
    picture.layers.push_back(ramp("", {"Z"}, 490, -3, false));
    picture.layers.push_back(ramp("", {"objectId"}, 490, 16777216 - 490, true));
    picture.layers.push_back(ramp("N", {"X", "Y", "Z"}, 490, 100, false));
    write_picture(picture, folder.file("a.exr"), 3, Tonemap::ACES);

    OIIO::ImageSpec spec;
    const std::vector<float> pixels = read_pixels<float>(folder.file("a.exr"), spec);
    ASSERT_EQ(spec.nchannels, 11);
    EXPECT_EQ(spec.channelnames[0] + spec.channelnames[1] + spec.channelnames[2], "RGB");
    for (const Layer& layer : picture.layers)
        for (size_t c = 0; c < layer.channel_names.size(); ++c) {
            const std::string name = (layer.name.empty() ? "" : layer.name + ".") + layer.channel_names[c];
            const int channel = spec.channelindex(name);
            ASSERT_GE(channel, 0) << name;
            EXPECT_EQ(spec.channelformat(channel), layer.is_id ? OIIO::TypeUInt32 : OIIO::TypeFloat) << name;
            for (size_t i = 0; i < 490 && !layer.is_id; ++i)
                ASSERT_EQ(std::memcmp(&pixels[i * 11 + static_cast<size_t>(channel)],
                                      &layer.values[i * layer.channel_names.size() + c], sizeof(float)),
                          0)
                    << name << " " << i;
        }
    const std::vector<std::uint32_t> words = read_pixels<std::uint32_t>(folder.file("a.exr"), spec);
    const auto id = static_cast<size_t>(spec.channelindex("objectId"));
    for (size_t i = 0; i < 490; ++i)
        ASSERT_EQ(words[i * 11 + id], 16777216 - 490 + i);
}

// X04: HALF ends at 65504 and would turn these into infinities.
TEST(Output, ExrHoldsRadianceBeyondTheRangeOfHalf) {
    const ScratchFolder folder;
    Picture picture = noise(2, 1);
    const std::vector<float> values = {65504.0f, 7e4f, 1e6f, 3.4e38f, 1e-7f, 1e-40f};
    picture.layers[0].values = values;
    picture.layers.push_back({"variance", {"R", "G", "B"}, values, false});
    write_picture(picture, folder.file("a.exr"), 0, Tonemap::NONE);
    OIIO::ImageSpec spec;
    const std::vector<float> read = read_pixels<float>(folder.file("a.exr"), spec);
    ASSERT_EQ(spec.nchannels, 6);
    for (int channel = 0; channel < spec.nchannels; ++channel)
        EXPECT_EQ(spec.channelformat(channel), OIIO::TypeFloat) << spec.channelnames[size_t(channel)];
    EXPECT_EQ(read, (std::vector<float>{65504.0f, 7e4f, 1e6f, 65504.0f, 7e4f, 1e6f, 3.4e38f, 1e-7f, 1e-40f,
                                        3.4e38f, 1e-7f, 1e-40f}));
}

TEST(Output, ExrKeepsTheWindowsPlaceAndTheMetadata) {
    ScratchFolder folder;
    Picture picture = noise(5, 4);
    picture.x0 = 3;
    picture.y0 = 2;
    picture.full_width = 20;
    picture.full_height = 10;
    picture.metadata = {
        {"device", "a device"}, {"version", "9"}, {"command", "clrt -o \"a b\" \xC3\xA4.obj"}};
    write_picture(picture, folder.file("a.exr"), 0, Tonemap::NONE);

    OIIO::ImageSpec spec;
    EXPECT_EQ(read_pixels<float>(folder.file("a.exr"), spec), picture.layers[0].values);
    EXPECT_EQ(spec.x, 3);
    EXPECT_EQ(spec.y, 2);
    EXPECT_EQ(spec.width, 5);
    EXPECT_EQ(spec.height, 4);
    EXPECT_EQ(spec.full_x, 0);
    EXPECT_EQ(spec.full_y, 0);
    EXPECT_EQ(spec.full_width, 20);
    EXPECT_EQ(spec.full_height, 10);
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    for (const auto& [name, value] : picture.metadata)
        EXPECT_EQ(spec.get_string_attribute("clrt." + name), value);
}

TEST(Output, EightBitFilesHoldTheDisplayedColours) {
    ScratchFolder folder;
    Picture picture = noise(33, 9);
    picture.x0 = 4; // a window: these formats hold it alone
    picture.full_width = 40;
    picture.layers.push_back(ramp("", {"Z"}, 297, 0, false));
    for (const char* extension : {"png", "bmp", "tga", "ppm", "PNG"}) {
        const std::string path = folder.file(std::string("a.") + extension);
        write_picture(picture, path, 0.5, Tonemap::REINHARD);
        OIIO::ImageSpec spec;
        const std::vector<std::uint8_t> pixels = read_pixels<std::uint8_t>(path, spec);
        ASSERT_EQ(spec.nchannels, 3) << path;
        ASSERT_EQ(spec.width, 33) << path;
        ASSERT_EQ(spec.height, 9) << path;
        for (size_t i = 0; i < pixels.size(); i += 3) {
            const std::vector<float>& v = picture.layers[0].values;
            const auto expected =
                display_colour({v[i], v[i + 1], v[i + 2]}, std::exp2(0.5), Tonemap::REINHARD);
            for (size_t c = 0; c < 3; ++c)
                ASSERT_EQ(pixels[i + c], expected[c]) << path << " " << i;
        }
    }
}

TEST(Output, JpegComesCloseToTheDisplayedColours) {
    ScratchFolder folder;
    Picture picture = noise(64, 64);
    for (size_t i = 0; i < picture.layers[0].values.size(); ++i) // a smooth ramp: JPEG is not made for noise
        picture.layers[0].values[i] = static_cast<float>(i / 3 % 64) / 64;
    write_picture(picture, folder.file("a.jpg"), 0, Tonemap::NONE);
    OIIO::ImageSpec spec;
    const std::vector<std::uint8_t> pixels = read_pixels<std::uint8_t>(folder.file("a.jpg"), spec);
    for (size_t i = 0; i < pixels.size(); ++i)
        ASSERT_NEAR(pixels[i], grey(static_cast<double>(picture.layers[0].values[i])), 4) << i;
}

TEST(Output, LinearFilesHoldTheRadiance) {
    ScratchFolder folder;
    Picture picture = noise(11, 13);
    picture.layers[0].values[5] = 1234.5f;
    OIIO::ImageSpec spec;
    for (const char* name : {"a.tif", "b.tiff"}) {
        write_picture(picture, folder.file(name), 5, Tonemap::ACES);
        EXPECT_EQ(read_pixels<float>(folder.file(name), spec), picture.layers[0].values);
    }

    // RGBE keeps 8 bits behind the largest channel's leading bit.
    picture.layers[0].values[0] = NOT_A_NUMBER;
    picture.layers[0].values[9] = INFINITE;
    write_picture(picture, folder.file("a.hdr"), 5, Tonemap::ACES);
    const std::vector<float> hdr = read_pixels<float>(folder.file("a.hdr"), spec);
    EXPECT_EQ(hdr[0], 0);
    EXPECT_GT(hdr[9], 9e37f);
    for (size_t i = 12; i < hdr.size(); i += 3) {
        const float* rgb = &picture.layers[0].values[i];
        const float largest = std::max({rgb[0], rgb[1], rgb[2]});
        for (size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(hdr[i + c], rgb[c], largest / 100) << i;
    }
}

TEST(Output, PfmHoldsTheRadianceFromTheBottomUp) {
    ScratchFolder folder;
    const Picture picture = noise(2, 3);
    write_picture(picture, folder.file("a.pfm"), 5, Tonemap::ACES);
    const std::string bytes = folder.read("a.pfm"), header = "PF\n2 3\n-1.0\n";
    ASSERT_EQ(bytes.substr(0, header.size()), header);
    ASSERT_EQ(bytes.size(), header.size() + 18 * sizeof(float));
    for (size_t y = 0; y < 3; ++y)
        EXPECT_EQ(
            std::memcmp(bytes.data() + header.size() + y * 24, &picture.layers[0].values[(2 - y) * 6], 24),
            0);
}

TEST(Output, WidestPicturesCanBeWritten) {
    ScratchFolder folder;
    for (const std::string& extension : EXTENSIONS) {
        const std::string path = folder.file("a." + extension);
        const int widest = largest_output_side(path);
        EXPECT_EQ(write_error(noise(widest, 2), path), "written");
        OIIO::ImageSpec spec;
        if (extension != "pfm") {
            EXPECT_EQ(read_pixels<float>(path, spec).size(), 6 * static_cast<size_t>(widest)) << path;
        }
    }
    EXPECT_NE(write_error(noise(65501, 2), folder.file("b.jpg")).find("expected at most 65500"),
              std::string::npos);
    EXPECT_EQ(folder.count(), EXTENSIONS.size());
}

TEST(Output, FullDiskLeavesTheOldFileAndNothingElse) {
    ScratchFolder folder;
    const Picture picture = noise(64, 64);
    for (const std::string& extension : EXTENSIONS) {
        const std::string name = "a." + extension;
        folder.write(name, "what was here before");
        std::string message;
        {
            FileSizeLimit limit(2048);
            message = write_error(picture, folder.file(name));
        }
        EXPECT_NE(message.find(folder.file(name) + ": "), std::string::npos) << message;
        EXPECT_NE(message.find(std::strerror(EFBIG)), std::string::npos) << message;
        EXPECT_EQ(folder.read(name), "what was here before");
        EXPECT_EQ(write_error(picture, folder.file(name)), "written");
        EXPECT_GT(folder.read(name).size(), 2048u);
    }
    EXPECT_EQ(folder.count(), EXTENSIONS.size());
}

TEST(Output, FolderThatCannotBeWrittenIsNamed) {
    ScratchFolder folder;
    const std::string locked = folder.file("locked"), file = folder.write("file", "");
    std::filesystem::create_directory(locked);
    std::filesystem::permissions(locked, std::filesystem::perms(0555));
    std::filesystem::permissions(folder.file(""), std::filesystem::perms(0755));
    const NotRoot not_root;
    const std::vector<std::pair<std::string, int>> cases = {
        {locked, EACCES}, {folder.file("absent"), ENOENT}, {file, ENOTDIR}};
    for (const auto& [place, reason] : cases) {
        const std::string path = place + "/a.png", message = write_error(noise(2, 2), path);
        EXPECT_NE(message.find(path), std::string::npos) << message;
        EXPECT_NE(message.find(std::strerror(reason)), std::string::npos) << message;
        try {
            check_output_folder(path);
            ADD_FAILURE() << place << " was accepted";
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find(std::strerror(reason)), std::string::npos)
                << error.what();
        }
    }
}

TEST(AtomicFile, AppearsOnlyOnCommit) {
    ScratchFolder folder;
    folder.write("a.txt", "old");
    {
        AtomicFile file(folder.file("a.txt"));
        file.write_at("new", 3, 0);
        EXPECT_EQ(file.size(), 3);
        EXPECT_EQ(folder.read("a.txt"), "old");
    }
    EXPECT_EQ(folder.read("a.txt"), "old");
    EXPECT_EQ(folder.count(), 1u);
    write_text_file(folder.file("a.txt"), "new");
    EXPECT_EQ(folder.read("a.txt"), "new");
    EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, FollowsLinksAndRefusesFoldersAndDevices) {
    ScratchFolder folder;
    folder.write("a.txt", "old");
    std::filesystem::create_symlink("a.txt", folder.file("link.txt"));
    write_text_file(folder.file("link.txt"), "new");
    EXPECT_EQ(folder.read("a.txt"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.txt")));
    EXPECT_THROW(write_text_file(folder.file(""), "x"), SceneError);
    EXPECT_THROW(write_text_file("/dev/null", "x"), SceneError);
}

TEST(AtomicFile, LeavesTheFileOfARunAloneThatIsAlive) {
    ScratchFolder folder;
    AtomicFile theirs(folder.file("a.txt"));
    theirs.write_at("theirs", 6, 0);
    write_text_file(folder.file("a.txt"), "ours");
    EXPECT_EQ(folder.read("a.txt"), "ours");
    theirs.commit();
    EXPECT_EQ(folder.read("a.txt"), "theirs");
    EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, RemovesWhatKilledRunsLeftOfTheSameFile) {
    ScratchFolder folder;
    const std::vector<std::string> others = {"b.txt.partial-12", "a.txt.partial-x", "a.txt.partial-12.png"};
    for (const std::string& name : others)
        folder.write(name, "not a leftover of this file");
    for (const char* number : {"12", "99999999-3"})
        folder.write(std::string("a.txt.partial-") + number, "left");
    folder.write("a.txt.partial-" + std::to_string(getpid()), "left by a run that had our number");
    write_text_file(folder.file("a.txt"), "ours");
    EXPECT_EQ(folder.read("a.txt"), "ours");
    EXPECT_EQ(folder.count(), 1 + others.size());
}

TEST(AtomicFile, StatisticsOnAFullDiskLeaveTheOldOnes) {
    ScratchFolder folder;
    folder.write("s.json", "older");
    {
        FileSizeLimit limit(100);
        EXPECT_THROW(write_text_file(folder.file("s.json"), std::string(200, 'x')), SceneError);
    }
    EXPECT_EQ(folder.read("s.json"), "older");
    EXPECT_EQ(folder.count(), 1u);
}

} // namespace clrt
