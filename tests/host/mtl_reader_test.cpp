// SPDX-License-Identifier: Apache-2.0
// Material libraries: keys, texture options, and which files a mtllib statement means.
#include "scene/readers/mtl_reader.h"

#include "error.h"
#include "scene/conductors.h"
#include "scene/readers/mtl_libraries.h"
#include "scene_support.h"

#include <gtest/gtest.h>

using namespace clrt;

namespace {

struct Parsed {
    std::vector<MtlMaterial> materials;
    std::vector<std::string> notices;
};

Parsed parse(const std::string& text) {
    NoticeList notices;
    std::vector<MtlMaterial> materials = parse_mtl(text, "a.mtl", notices);
    return {std::move(materials), notices.lines()};
}

/// One material whose newmtl is line 1.
MtlMaterial parse_one(const std::string& text) {
    return parse("newmtl m\n" + text).materials.at(0);
}

MtlTexture texture(const std::string& value) {
    return parse_one("map_Kd " + value).map_kd.value();
}

std::string error_of(const std::string& text) {
    try {
        parse(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

std::map<std::string, MtlMaterial> libraries(const TemporaryFolder& folder, const std::string& names,
                                             NoticeList& notices) {
    std::vector<NamedFile> files;
    return read_mtl_libraries(folder.path("scene.obj"), {{names, 3}}, notices, files);
}

} // namespace

TEST(MtlReader, ReadsEveryKey) {
    const MtlMaterial m =
        parse_one("Ka .6 .7 9\nKd .1 .2 .3\nKs 0.4 0.5 0.6\nKe 7 8 9\nTf 0.9 0.8 0.7\nNs 33\nNi 1.4\n"
                  "illum 7\nd 0.25\nTr 0.75\nPr 0.2\nPm 0.3\naniso 0.4\nPs 0.5\nPc 4\nPcr 0.1\nanisor 1.5\n");
    EXPECT_EQ(m.ka, glm::dvec3(0.6, 0.7, 1));
    EXPECT_EQ(m.kd, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(m.ks, glm::dvec3(0.4, 0.5, 0.6));
    EXPECT_EQ(m.ke, glm::dvec3(7, 8, 9));
    EXPECT_EQ(m.tf, glm::dvec3(0.9, 0.8, 0.7));
    EXPECT_EQ(m.ns, 33);
    EXPECT_EQ(m.ni, 1.4);
    EXPECT_EQ(m.illum, 7);
    EXPECT_EQ(m.d, 0.25);
    EXPECT_EQ(m.tr, 0.75);
    EXPECT_EQ(m.pr, 0.2);
    EXPECT_EQ(m.pm, 0.3);
    EXPECT_EQ(m.aniso, 0.4);
    EXPECT_EQ(m.ps, 0.5);
    EXPECT_EQ(m.pc, 4);
    EXPECT_EQ(m.pcr, 0.1);
    EXPECT_EQ(m.anisor, 1.5);
}

TEST(MtlReader, MetalsAreGivenByTheirIndexOrTheirName) {
    const MtlMaterial m = parse_one("eta 0.2 1.1 1.2\nk 3.9 2.4 2.2\n");
    EXPECT_EQ(m.eta, glm::dvec3(0.2, 1.1, 1.2));
    EXPECT_EQ(m.k, glm::dvec3(3.9, 2.4, 2.2));
    for (const std::string& name : conductor_names()) {
        const MtlMaterial named = parse_one("conductor " + name + " # a metal\n");
        EXPECT_EQ(named.eta, find_conductor(name)->eta) << name;
        EXPECT_EQ(named.k, find_conductor(name)->k) << name;
    }
    EXPECT_EQ(parse_one("Conductor GOLD\n").eta, find_conductor("gold")->eta);
    const Parsed p = parse("newmtl m\nconductor unobtainium\n");
    EXPECT_FALSE(p.materials[0].eta);
    EXPECT_EQ(count_notices(p.notices, "a.mtl:2: conductor 'unobtainium' is no known metal"), 1);
    EXPECT_EQ(count_notices(p.notices, "aluminium, brass, copper, gold"), 1);
}

TEST(MtlReader, AMeasuredBrdfIsAFileAndItsPlace) {
    const Parsed p = parse("newmtl m\nMerl  my samples/gold 1.binary  # a metal\n");
    EXPECT_EQ(p.materials[0].merl->file, "my samples/gold 1.binary");
    EXPECT_EQ(p.materials[0].merl->place.line, 2u);
    EXPECT_TRUE(p.notices.empty());
    EXPECT_THROW(parse("newmtl m\nmerl\n"), SceneError);
}

TEST(MtlReader, AbsentKeysStayAbsent) {
    const MtlMaterial m = parse_one("");
    EXPECT_FALSE(m.ka || m.kd || m.ks || m.ke || m.tf || m.ns || m.ni || m.d || m.tr || m.pr || m.pm ||
                 m.ps || m.pc || m.pcr || m.aniso || m.anisor || m.illum || m.dielectric_f0);
    EXPECT_FALSE(m.map_kd || m.map_ks || m.map_ke || m.map_d || m.map_pr || m.map_pm || m.map_ps ||
                 m.map_normal || m.map_bump || m.map_ns || m.map_refl || m.map_dielectric_f0);
}

TEST(MtlReader, KeysKnowTheirLines) {
    const MtlMaterial m = parse_one("KD 1 1 1\n\nbump b.png\nKt 1 1 1\nKd 0.5\n");
    EXPECT_EQ(m.place_of("kd").line, 6u) << "the last one counts";
    EXPECT_EQ(m.place_of("map_bump").line, 4u);
    EXPECT_EQ(m.place_of("tf").line, 5u);
    EXPECT_EQ(m.place_of("ns").line, 1u) << "absent: that of newmtl";
    EXPECT_EQ(m.place_of("kd").file, "a.mtl");
}

TEST(MtlReader, ReadsEveryMap) {
    const MtlMaterial m =
        parse_one("map_Kd 1\nmap_Ks 2\nmap_Ke 3\nmap_d 4\nmap_Pr 5\nmap_Pm 6\nnorm 7\nbump 8\n"
                  "map_Ns 9\nmap_refl 10\nmap_Ps 11\n");
    EXPECT_EQ(m.map_kd->file, "1");
    EXPECT_EQ(m.map_ks->file, "2");
    EXPECT_EQ(m.map_ke->file, "3");
    EXPECT_EQ(m.map_d->file, "4");
    EXPECT_EQ(m.map_pr->file, "5");
    EXPECT_EQ(m.map_pm->file, "6");
    EXPECT_EQ(m.map_normal->file, "7");
    EXPECT_EQ(m.map_bump->file, "8");
    EXPECT_EQ(m.map_ns->file, "9");
    EXPECT_EQ(m.map_refl->file, "10");
    EXPECT_EQ(m.map_ps->file, "11");
    EXPECT_EQ(parse_one("refl r.png").map_refl->file, "r.png");
    EXPECT_EQ(m.map_bump->place.line, 9u);
    EXPECT_EQ(parse_one("map_Bump x.png").map_bump->file, "x.png");
}

TEST(MtlReader, ToleratesCaseTabsCommentsAndWindowsLines) {
    const Parsed p = parse("\xef\xbb\xbf# head\r\n\tNEWMTL  my metal \r\n\r\n\t  KD\t0.5 0.25 1\t# "
                           "orange\r\n  NS 20\r\n");
    ASSERT_EQ(p.materials.size(), 1u);
    EXPECT_EQ(p.materials[0].name, "my metal");
    EXPECT_EQ(p.materials[0].place.line, 2u);
    EXPECT_EQ(p.materials[0].kd, glm::dvec3(0.5, 0.25, 1));
}

TEST(MtlReader, OneComponentIsGrey) {
    EXPECT_EQ(parse_one("Kd 0.5").kd, glm::dvec3(0.5));
    EXPECT_EQ(parse_one("Ke 3 # white").ke, glm::dvec3(3));
}

TEST(MtlReader, KtIsTf) {
    EXPECT_EQ(parse_one("Kt 0.1 0.2 0.3").tf, glm::dvec3(0.1, 0.2, 0.3));
}

TEST(MtlReader, HaloIsReadAsCoverage) {
    const Parsed p = parse("newmtl a\nd -halo 0.3\n");
    EXPECT_EQ(p.materials[0].d, 0.3);
    EXPECT_EQ(count_notices(p.notices, "a.mtl:2: d -halo"), 1);
}

TEST(MtlReader, BadNumbersAreErrorsWithTheirLine) {
    EXPECT_EQ(error_of("newmtl a\nKd 0.1 zwei 0.3\n"), "a.mtl:2: Kd: expected a finite number, found 'zwei'");
    EXPECT_EQ(error_of("newmtl a\n\nNs\n"),
              "a.mtl:3: Ns: expected a finite number, found the end of the line");
    EXPECT_EQ(error_of("newmtl a\nKe nan 0 0\n"), "a.mtl:2: Ke: expected a finite number, found 'nan'");
    EXPECT_EQ(error_of("newmtl a\nKd 0.1 0.2\n"),
              "a.mtl:2: Kd: expected a finite number, found the end of the line");
    EXPECT_EQ(error_of("newmtl a\nNs 20#x\n"), "a.mtl:2: Ns: expected a finite number, found '20#x'");
    EXPECT_EQ(error_of("newmtl a\nillum two\n"), "a.mtl:2: illum: expected a finite number, found 'two'");
}

TEST(MtlReader, ValuesOutsideTheirRangeAreClampedWithOneNotice) {
    const Parsed p = parse("newmtl a\nKd 2 0.5 -1\nNs -5\nd 1.5\nKe -1 3 0\nnewmtl b\nKd 3 3 3\nPr 7\n");
    EXPECT_EQ(p.materials[0].kd, glm::dvec3(1, 0.5, 0));
    EXPECT_EQ(p.materials[0].ns, 0);
    EXPECT_EQ(p.materials[0].d, 1);
    EXPECT_EQ(p.materials[0].ke, glm::dvec3(0, 3, 0));
    EXPECT_EQ(p.materials[1].pr, 1);
    EXPECT_EQ(count_notices(p.notices, "a.mtl:2: Kd outside [0,1] is clamped (and 4 more)"), 1);
    EXPECT_EQ(count_notices(p.notices, "a.mtl:8: Pr outside [0,1] is clamped"), 1);
}

TEST(MtlReader, ImpossibleIorAndIllumFallBack) {
    const Parsed p = parse("newmtl a\nNi 0\nillum 10\nnewmtl b\nillum 2.5\nNi 1\n");
    EXPECT_FALSE(p.materials[0].ni);
    EXPECT_FALSE(p.materials[0].illum);
    EXPECT_FALSE(p.materials[1].illum);
    EXPECT_EQ(p.materials[1].ni, 1);
    EXPECT_EQ(count_notices(p.notices, "a.mtl:2: Ni"), 1);
    EXPECT_EQ(count_notices(p.notices, "a.mtl:3: illum 10 is no known model"), 1);
}

TEST(MtlReader, IgnoredKeysAreListedOnce) {
    const Parsed p =
        parse("newmtl a\nKm 1\nmap_Ka x.png\nwhat ever\nnewmtl b\nKm 2\nTf spectral x.rfl 1\nKd xyz 1 1 1\n");
    EXPECT_EQ(count_notices(p.notices, "a.mtl:2: Km has no effect here and is ignored (and 1 more)"), 1);
    EXPECT_EQ(count_notices(p.notices, "map_Ka has no effect"), 1);
    EXPECT_EQ(count_notices(p.notices, "what has no effect"), 1);
    EXPECT_EQ(count_notices(p.notices, "Tf spectral is not supported"), 1);
    EXPECT_EQ(count_notices(p.notices, "Kd xyz is not supported"), 1);
    EXPECT_EQ(p.notices.size(), 5u);
    EXPECT_FALSE(p.materials[1].tf || p.materials[1].kd);
}

TEST(MtlReader, AmbientColoursAreReadSilently) {
    EXPECT_TRUE(parse("newmtl a\nKa 1 1 1\n").notices.empty());
    for (const char* odd : {"Ka", "Ka 1", "Ka spectral x.rfl 1", "Ka 1 red 1", "Ka 1 nan 1"}) {
        const Parsed p = parse(std::string("newmtl a\n") + odd + "\n");
        EXPECT_FALSE(p.materials[0].ka) << odd;
        EXPECT_TRUE(p.notices.empty()) << odd;
    }
}

TEST(MtlReader, StatementsBeforeTheFirstMaterialAreIgnored) {
    const Parsed p = parse("Kd 1 0 0\nNs nonsense\nnewmtl a\n");
    EXPECT_EQ(p.materials.size(), 1u);
    EXPECT_EQ(
        count_notices(p.notices, "a.mtl:1: a statement before the first newmtl is ignored (and 1 more)"), 1);
}

TEST(MtlReader, AnyBytesAreSafe) {
    unsigned state = 1;
    for (int round = 0; round < 2000; ++round) {
        std::string text = "newmtl a\n";
        for (int i = 0; i < 60; ++i) {
            state = state * 1664525u + 1013904223u;
            const char* words[] = {"Kd ",  "map_Kd ", "-s ",      "-bm ",   "1 ", "\n",
                                   "\\\n", "#",       "d -halo ", "illum ", "\r", "norm "};
            text += state >> 28 < 12 ? std::string(words[state >> 28]) : std::string(1, char(state >> 16));
        }
        try {
            parse(text);
        } catch (const SceneError&) {
        }
    }
}

TEST(MtlTexture, ReadsOptionsAndNamesWithSpaces) {
    const MtlTexture t =
        texture("-s 2 3 4 -o 0.5 0.25 -mm 0.1 0.8 -bm 3 -clamp on -imfchan g my nice picture.png # wood");
    EXPECT_EQ(t.file, "my nice picture.png");
    EXPECT_EQ(t.scale, glm::dvec2(2, 3));
    EXPECT_EQ(t.offset, glm::dvec2(0.5, 0.25));
    EXPECT_EQ(t.base, 0.1);
    EXPECT_EQ(t.gain, 0.8);
    EXPECT_EQ(t.bump_multiplier, 3);
    EXPECT_TRUE(t.wrap_u == TextureWrap::BLACK && t.wrap_v == TextureWrap::BLACK);
    EXPECT_EQ(t.channel, 1u);
}

TEST(MtlTexture, DefaultsChangeNothing) {
    const MtlTexture t = texture("a.png");
    EXPECT_EQ(t.scale, glm::dvec2(1));
    EXPECT_EQ(t.offset, glm::dvec2(0));
    EXPECT_EQ(t.base, 0);
    EXPECT_EQ(t.gain, 1);
    EXPECT_EQ(t.bump_multiplier, 1);
    EXPECT_TRUE(t.wrap_u == TextureWrap::REPEAT && !t.channel);
}

TEST(MtlTexture, VectorsMayHaveOneToThreeNumbers) {
    EXPECT_EQ(texture("-s 2 a.png").scale, glm::dvec2(2, 1));
    EXPECT_EQ(texture("-s 2 3 a.png").scale, glm::dvec2(2, 3));
    EXPECT_EQ(texture("-o 2 a.png").offset, glm::dvec2(2, 0));
    EXPECT_EQ(texture("-o 1 2 3 4").file, "4") << "a file name may look like a number";
    EXPECT_EQ(texture("-o 1 2").file, "2");
}

TEST(MtlTexture, OptionsMayFollowTheName) {
    const MtlTexture t = texture("-clamp off a b.png -bm 1.5 -imfchan m");
    EXPECT_EQ(t.file, "a b.png");
    EXPECT_EQ(t.bump_multiplier, 1.5);
    EXPECT_EQ(t.channel, 3u);
}

TEST(MtlTexture, ChannelsMapToTheKernelsNumbers) {
    EXPECT_EQ(texture("-imfchan r a").channel, 0u);
    EXPECT_EQ(texture("-imfchan b a").channel, 2u);
    EXPECT_EQ(texture("-imfchan l a").channel, 4u);
    EXPECT_FALSE(texture("-imfchan z a").channel);
}

TEST(MtlTexture, IgnoredOptionsAreNotedOnlyWhereTheyMatter) {
    const Parsed quiet = parse("newmtl a\nmap_Kd -blendu on -blendv on -cc off -t 0 0 0 a.png\n");
    EXPECT_TRUE(quiet.notices.empty());
    EXPECT_EQ(quiet.materials[0].map_kd->file, "a.png");
    const Parsed loud = parse("newmtl a\nmap_Kd -blendu off -cc on -t 1 -boost 2 -texres 512 -type sphere "
                              "-colorspace sRGB a.png\n");
    EXPECT_EQ(loud.notices.size(), 7u);
    EXPECT_EQ(loud.materials[0].map_kd->file, "a.png");
}

TEST(MtlTexture, BadOptionsAreErrorsWithTheirLine) {
    EXPECT_EQ(error_of("newmtl a\nmap_Kd -s x a.png\n"),
              "a.mtl:2: map_Kd -s: expected a finite number, found 'x'");
    EXPECT_EQ(error_of("newmtl a\nbump -bm\n"),
              "a.mtl:2: bump -bm: expected a finite number, found the end of the line");
    EXPECT_EQ(error_of("newmtl a\nmap_Kd -clamp maybe a.png\n"),
              "a.mtl:2: map_Kd -clamp: expected on or off, found 'maybe'");
    EXPECT_EQ(error_of("newmtl a\nmap_d -imfchan q a.png\n"),
              "a.mtl:2: map_d -imfchan: expected one of r g b m l z, found 'q'");
}

TEST(MtlTexture, UnknownOptionsAreNamedAndLeftOut) {
    const TemporaryFolder folder;
    for (const char* name : {"tex.png", "my tex.png"})
        folder.write(name, "");
    const auto read = [&](const std::string& value) {
        NoticeList notices;
        auto materials = parse_mtl("newmtl a\nmap_Kd " + value, folder.path("a.mtl"), notices);
        return Parsed{std::move(materials), notices.lines()};
    };
    const auto expect = [&](const std::string& value, const std::string& file, size_t count) {
        const Parsed p = read(value);
        ASSERT_TRUE(p.materials[0].map_kd) << value;
        EXPECT_EQ(p.materials[0].map_kd->file, file) << value;
        EXPECT_EQ(count_notices(p.notices, folder.path("a.mtl") + ":2: map_Kd: unknown option '-foo', which "
                                                                  "is left out; expected one of -s -o -t "),
                  int(count))
            << value;
        EXPECT_EQ(p.notices.size(), count) << value;
    };
    expect("-foo tex.png", "tex.png", 1);
    expect("-foo 1 on my tex.png", "my tex.png", 1);
    expect("-foo missing.png", "missing.png", 1);
    expect("-clamp on -foo 3 -4 -bm 2 my tex.png", "my tex.png", 1);
    expect("tex.png -foo", "tex.png", 1);
    expect("my tex.png -foo 2 # wood", "my tex.png", 1);
    expect("tex.png -bm 2 -foo 3 -clamp on", "tex.png", 1);
    expect("tex.png -foo 3 -bm 2", "tex.png", 1);
    for (const char* value : {"-foo 3 -bm 2 tex.png", "tex.png -foo 3 -bm 2", "tex.png -bm 2 -foo 3"})
        EXPECT_EQ(read(value).materials[0].map_kd->bump_multiplier, 2) << value;
    // What may be a name is one.
    expect("-gone.png", "-gone.png", 0);
    expect("-1.png", "-1.png", 0);
    expect("tex - old.png", "tex - old.png", 0);
    expect("gone -foo.png", "gone -foo.png", 0);
    for (const char* name : {"-foo.png", "-foo tex.png", "tex.png -foo.png"}) {
        folder.write(name, "");
        expect(name, name, 0);
        expect(std::string("-bm 2 ") + name + " -clamp on", name, 0);
    }
}

TEST(MtlTexture, AMapWithoutAFileIsIgnored) {
    const Parsed p = parse("newmtl a\nmap_Kd -clamp on\n");
    EXPECT_FALSE(p.materials[0].map_kd);
    EXPECT_EQ(count_notices(p.notices, "map_Kd names no file"), 1);
}

TEST(MtlLibraries, TheWholeTextMayBeOneName) {
    const TemporaryFolder folder;
    folder.write("my nice lib.mtl", "newmtl a\n");
    folder.write("lib.mtl", "newmtl wrong\n");
    NoticeList notices;
    const auto found = libraries(folder, "my nice lib.mtl", notices);
    EXPECT_EQ(found.size(), 1u);
    EXPECT_EQ(found.count("a"), 1u);
    EXPECT_TRUE(notices.lines().empty());
}

TEST(MtlLibraries, SeveralNamesMayHaveSpacesEach) {
    const TemporaryFolder folder;
    folder.write("a b.mtl", "newmtl ab\n");
    folder.write("c.mtl", "newmtl c\n");
    folder.write("d e.mtl", "newmtl de\n");
    NoticeList notices;
    const auto found = libraries(folder, "a b.mtl none.mtl c.mtl  d e.mtl", notices);
    EXPECT_EQ(found.size(), 3u);
    EXPECT_EQ(count_notices(notices, "scene.obj:3: mtllib: no file 'none.mtl' found"), 1);
    EXPECT_EQ(notices.lines().size(), 1u);
}

TEST(MtlLibraries, PathsOfOtherSystemsAreFound) {
    const TemporaryFolder folder;
    folder.write("sub/a.mtl", "newmtl a\n");
    folder.write("b.mtl", "newmtl b\n");
    folder.write("c d.mtl", "newmtl c\n");
    NoticeList notices;
    EXPECT_EQ(libraries(folder, "sub\\a.mtl", notices).count("a"), 1u);
    EXPECT_EQ(libraries(folder, "C:\\Models\\b.mtl", notices).count("b"), 1u);
    EXPECT_EQ(libraries(folder, "C:\\My Models\\c d.mtl", notices).count("c"), 1u);
    EXPECT_EQ(libraries(folder, "c\\ d.mtl", notices).count("c"), 1u);
    EXPECT_EQ(libraries(folder, "/nowhere/b.mtl sub/a.mtl", notices).size(), 2u);
    folder.write("e.mtl", "newmtl e\n");
    EXPECT_EQ(libraries(folder, "/nowhere/b.mtl /nowhere/e.mtl", notices).size(), 2u)
        << "the last name must not hide the first";
    EXPECT_TRUE(notices.lines().empty());
}

TEST(MtlLibraries, CaseTellsFilesApartOnlyWhereItMust) {
    const TemporaryFolder folder;
    folder.write("Maps/Room.MTL", "newmtl maps\n");
    folder.write("a.mtl", "newmtl lower\n");
    folder.write("A.mtl", "newmtl upper\n");
    folder.write("beside.mtl", "newmtl beside\n");
    NoticeList notices;
    EXPECT_EQ(libraries(folder, "maps\\room.mtl", notices).count("maps"), 1u);
    EXPECT_EQ(libraries(folder, "C:\\Models\\BESIDE.MTL", notices).count("beside"), 1u);
    EXPECT_EQ(libraries(folder, "a.mtl", notices).count("lower"), 1u);
    EXPECT_EQ(libraries(folder, "A.mtl", notices).count("upper"), 1u);
    EXPECT_EQ(libraries(folder, "a.MTL", notices).count("upper"), 1u) << "the first by name";
    EXPECT_TRUE(notices.lines().empty());
    EXPECT_EQ(libraries(folder, "maps/rooms.mtl", notices).size(), 0u);
    EXPECT_EQ(count_notices(notices, "no file 'maps/rooms.mtl' found"), 1);
}

TEST(MtlLibraries, TheFirstDefinitionOfANameCounts) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\nNs 1\nnewmtl m\nNs 2\n");
    folder.write("b.mtl", "newmtl m\nNs 3\n");
    NoticeList notices;
    const auto found = libraries(folder, "a.mtl b.mtl", notices);
    EXPECT_EQ(found.at("m").ns, 1);
    EXPECT_EQ(count_notices(
                  notices, "a.mtl:3: newmtl 'm': defined before, the first definition is taken (and 1 more)"),
              1);
}

TEST(MtlLibraries, ALibraryNamedTwiceIsReadOnce) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\nKm 1\n");
    NoticeList notices;
    std::vector<NamedFile> files;
    read_mtl_libraries(folder.path("scene.obj"), {{"a.mtl", 1}, {"a.mtl", 9}}, notices, files);
    EXPECT_EQ(count_notices(notices, "Km has no effect here and is ignored"), 1);
    EXPECT_EQ(count_notices(notices, "more"), 0);
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].path, folder.path("a.mtl"));
}
