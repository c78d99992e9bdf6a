// SPDX-License-Identifier: Apache-2.0
// Film files: what is written is read, what is damaged is refused.
#include "film/film_file.h"

#include "error.h"
#include "probes/scratch_folder.h"
#include "support/file_size_limit.h"
#include "support/noise_film.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A small film with something in every field.
FilmFile make_film() {
    FilmFile file;
    std::mt19937 random(1);
    file.render.film = empty_film(5, 3, 4, 8, 12);
    file.render.film.ranges.push_back({40, 44});
    fill_with_noise(file.render.film, 2, 1, random);
    file.render.film.sums[0] = INT64_MIN;
    file.identity = {{"scene", "abc"},
                     {"window", {1, 2, 6, 5}},
                     {"size", {10, 20}},
                     {"quantum", file.render.film.scale.quantum},
                     {"largest", file.render.film.scale.largest}};
    file.identity["layers"] = {{{"name", "direct"}, {"expression", "LDE"}}};
    file.render.path_layers = {film_layer(file.render.film)};
    file.render.path_layers[0].sums.assign(film_plane(file.render.film), 77);
    file.origin = {{"clrt", "--spp=12", "--", "a \"b\".obj"}, "/some/folder", "a device"};
    RenderCounts& counts = file.render.counts;
    counts.primary = 1ull << 40;
    counts.shadow = 3;
    counts.nan = 2;
    counts.cut_paths = 5;
    counts.cut_weight = 1ull << 41;
    file.bias.cut_radiance = 1.0 / 3;
    file.bias.blind_spots = {{"LpS+DE", "a light", "a.mtl:3"}};
    file.bias.hits = {{"LS+DE", 1.0 / 7}};
    counts.bad_samples = {{7, 9}, {8, 10}};
    file.render.history = {{8, 0.1, 1.0 / 3, {1, 2, 3, 0.1}}};
    file.render.film.shown = {0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 1};
    file.render.seconds = 1.1;
    return file;
}

class FilmFileTest : public testing::Test {
protected:
    /// The message with which a file is refused.
    static std::string refusal_of(const std::string& path) {
        try {
            read_film_file(path);
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find(path + ": "), std::string::npos) << error.what();
            return error.what();
        }
        return "accepted";
    }
    /// The message with which a file of these bytes is refused.
    std::string refusal(const std::string& bytes) const {
        return refusal_of(folder.write("bad.film", bytes));
    }
    void expect_refused(const std::string& bytes, const std::string& part) const {
        const std::string message = refusal(bytes);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    }
    std::string bytes() const {
        write_film_file(folder.file("good.film"), make_film());
        return folder.read("good.film");
    }
    ScratchFolder folder;
};

} // namespace

TEST_F(FilmFileTest, AFullDiskLeavesTheOlderFilmWhole) {
    const std::string older = bytes();
    for (const size_t room : {size_t(0), size_t(10), older.size() - 1}) {
        const FileSizeLimit limit(room);
        EXPECT_THROW(write_film_file(folder.file("good.film"), make_film()), SceneError) << room;
    }
    EXPECT_EQ(folder.read("good.film"), older);
    EXPECT_EQ(folder.count(), 1u);
    EXPECT_NO_THROW(read_film_file(folder.file("good.film")));
}

TEST_F(FilmFileTest, EverythingComesBack) {
    const FilmFile written = make_film();
    write_film_file(folder.file("a.film"), written);
    const FilmFile read = read_film_file(folder.file("a.film"));
    EXPECT_EQ(read.identity, written.identity);
    EXPECT_EQ(read.origin.command, written.origin.command);
    EXPECT_EQ(read.origin.folder, written.origin.folder);
    EXPECT_EQ(read.origin.device, written.origin.device);
    const Film &a = read.render.film, &b = written.render.film;
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.replicates, b.replicates);
    EXPECT_EQ(a.scale.quantum, b.scale.quantum);
    EXPECT_EQ(a.scale.largest, b.scale.largest);
    EXPECT_EQ(a.ranges, b.ranges);
    EXPECT_EQ(a.sums, b.sums);
    EXPECT_EQ(a.shown, b.shown);
    ASSERT_EQ(read.render.path_layers.size(), 1u);
    EXPECT_EQ(read.render.path_layers[0].sums, written.render.path_layers[0].sums);
    EXPECT_EQ(read.render.path_layers[0].ranges, b.ranges);
    EXPECT_EQ(read.render.counts.primary, written.render.counts.primary);
    EXPECT_EQ(read.render.counts.shadow, 3u);
    EXPECT_EQ(read.render.counts.nan, 2u);
    EXPECT_EQ(read.render.counts.cut_paths, 5u);
    EXPECT_EQ(read.render.counts.cut_weight, 1ull << 41);
    EXPECT_EQ(read.bias.cut_radiance, 1.0 / 3);
    ASSERT_EQ(read.bias.blind_spots.size(), 1u);
    EXPECT_EQ(read.bias.blind_spots[0].where, "a.mtl:3");
    ASSERT_TRUE(read.bias.hits);
    EXPECT_EQ(read.bias.hits->paths, "LS+DE");
    EXPECT_EQ(read.bias.hits->radiance, 1.0 / 7);
    EXPECT_EQ(read.render.counts.bad_samples, written.render.counts.bad_samples);
    ASSERT_EQ(read.render.history.size(), 1u);
    EXPECT_EQ(read.render.history[0].samples, 8u);
    EXPECT_EQ(read.render.history[0].mean_radiance, 1.0 / 3) << "to the last bit";
    EXPECT_EQ(read.render.history[0].without, written.render.history[0].without);
    EXPECT_EQ(read.render.seconds, 1.1);
    EXPECT_EQ(folder.count(), 1u) << "no temporary file";
}

TEST_F(FilmFileTest, PixelsOfTheSceneAreThoseOfTheWindowOrNotKnown) {
    FilmFile film = make_film();
    for (const std::vector<std::uint8_t>& shown :
         {std::vector<std::uint8_t>(15, 1), std::vector<std::uint8_t>(15, 0), std::vector<std::uint8_t>()}) {
        film.render.film.shown = shown;
        write_film_file(folder.file("a.film"), film);
        EXPECT_EQ(read_film_file(folder.file("a.film")).render.film.shown, shown);
    }
    for (const size_t pixels : {1, 14, 16, 1000}) {
        film.render.film.shown.assign(pixels, 1);
        write_film_file(folder.file("a.film"), film);
        expect_refused(folder.read("a.film"), "damaged: the pixels that show the scene");
    }
}

TEST_F(FilmFileTest, TheLayoutIsTheDocumentedOne) {
    const std::string file = bytes();
    EXPECT_EQ(file.substr(0, 8), "CLRTFILM");
    EXPECT_EQ(file.substr(8, 4), std::string("\3\0\0\0", 4));
    const auto byte = [&](size_t i) { return size_t(static_cast<unsigned char>(file[i])); };
    const size_t header = byte(12) + 256 * byte(13);
    EXPECT_EQ(file[16], '{');
    EXPECT_EQ(file[16 + header - 1], '}');
    EXPECT_EQ(file.size(), 16 + header + 8 * (4 + 1) * 5 * 3 * 3 + 16);
    EXPECT_EQ(file.substr(16 + header, 8), std::string("\0\0\0\0\0\0\0\x80", 8)) << "the smallest integer";
}

TEST_F(FilmFileTest, EveryTruncationIsRefused) {
    const std::string file = bytes();
    for (size_t size = 0; size < file.size(); size += size < 40 ? 1 : 37)
        EXPECT_NE(refusal(file.substr(0, size)), "accepted") << size;
    expect_refused(file.substr(0, file.size() - 1), "truncated: expected " + std::to_string(file.size()) +
                                                        " bytes, found " + std::to_string(file.size() - 1));
    expect_refused(file + "x", "damaged: expected " + std::to_string(file.size()) + " bytes");
}

TEST_F(FilmFileTest, EveryFlippedBitIsRefused) {
    const std::string file = bytes();
    for (size_t i = 0; i < file.size(); ++i) {
        std::string damaged = file;
        damaged[i] = char(damaged[i] ^ (1 << (i % 8)));
        EXPECT_NE(refusal(damaged), "accepted") << "byte " << i;
    }
    std::string damaged = file;
    damaged[file.size() - 100] = char(damaged[file.size() - 100] ^ 1);
    expect_refused(damaged, "damaged: the checksum");
}

TEST_F(FilmFileTest, AGuideComesBackAndOneThatCannotBeIsRefused) {
    FilmFile film = make_film();
    GuideProgress& guide = film.render.guide;
    guide.stage = GuideStage::ON;
    guide.epoch = 2;
    guide.end = 64;
    guide.pilot_error = 1.0 / 3;
    guide.weights = {0.5f, 2, 0};
    guide.gain = -1.25;
    guide.guide.emplace();
    std::vector<std::uint64_t> sums(GUIDE_SIDES * GUIDE_SUMS);
    sums[0] = (std::uint64_t(800) << GUIDE_SUM_BITS) + 800000; // divides a cell
    sums[GUIDE_SUM_VERTICES] = 1600;
    guide.guide->learn(sums);
    guide.sums.assign(guide.guide->lore().size() * GUIDE_SUMS, 7);
    write_film_file(folder.file("guided.film"), film);
    const GuideProgress read = read_film_file(folder.file("guided.film")).render.guide;
    EXPECT_EQ(read.epoch, 2u);
    EXPECT_EQ(read.pilot_error, guide.pilot_error);
    EXPECT_EQ(read.sums, guide.sums);
    EXPECT_EQ(read.weights, guide.weights);
    EXPECT_EQ(read.gain, guide.gain);
    ASSERT_EQ(read.guide->lore().size(), guide.guide->lore().size());
    EXPECT_EQ(read.guide->lore()[0].splits, guide.guide->lore()[0].splits);
    EXPECT_EQ(read.guide->lore()[0].weight.count, guide.guide->lore()[0].weight.count);

    // A link to nowhere, one that leads back, a cell that there is not.
    const std::vector<u32> nodes = guide.guide->nodes();
    ASSERT_FALSE(nodes[0] & GUIDE_LEAF);
    for (const u32 link : {1000u, 0u, GUIDE_LEAF | 1000u}) {
        std::vector<u32> broken = nodes;
        broken[0] = link;
        guide.guide.emplace(broken, read.guide->lore());
        write_film_file(folder.file("guided.film"), film);
        expect_refused(folder.read("guided.film"), "damaged: the cells of its guide are impossible");
    }
}

TEST_F(FilmFileTest, OtherFilesAreRefusedByWhatTheyAre) {
    expect_refused("\x76\x2f\x31\x01 is how a picture starts",
                   "expected a film file as --checkpoint writes it");
    std::string newer = bytes();
    newer[8] = 4;
    expect_refused(newer, "expected format version 3, found 4");
    EXPECT_EQ(refusal_of(folder.file("none.film")),
              folder.file("none.film") + ": the film file cannot be opened: No such file or directory");
    EXPECT_EQ(refusal_of(folder.file("")),
              folder.file("") + ": the film file cannot be opened: Is a directory");
}

TEST_F(FilmFileTest, TheOriginIsReadWithoutTheSums) {
    const std::string file = bytes();
    folder.write("short.film", file.substr(0, file.size() - 300));
    EXPECT_EQ(read_film_origin(folder.file("short.film")).command, make_film().origin.command);
    folder.write("other.film", "no film at all");
    EXPECT_THROW(read_film_origin(folder.file("other.film")), SceneError);
}

} // namespace clrt
