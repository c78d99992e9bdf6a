// SPDX-License-Identifier: Apache-2.0
// Reading kernel files and expanding their includes.
#include "device/kernel_source.h"
#include "error.h"
#include "probes/scratch_folder.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>

using namespace clrt;
using testing::HasSubstr;

namespace {

std::string refusal(const KernelFiles& files, const std::string& entry) {
    try {
        return "expanded to " + expand_kernel_source(files, entry);
    } catch (const SceneError& error) {
        return error.what();
    }
}

size_t occurrences(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

/// A new folder that goes when the test ends.
class KernelFolder : public testing::Test {
protected:
    void write(const std::string& file, const std::string& text) {
        std::filesystem::create_directories((folder_ / file).parent_path());
        std::ofstream(folder_ / file) << text;
    }

    const ScratchFolder scratch_;
    const std::filesystem::path folder_ = std::filesystem::path(scratch_.file("any")).parent_path();
};

} // namespace

TEST(KernelSource, IncludesAreReplacedAndLinesKeepTheirFileAndNumber) {
    const KernelFiles files = {{"a.cl", "one\n#include \"lib/b.h\"\nthree\n"}, {"lib/b.h", "b one\nb two\n"}};
    EXPECT_EQ(expand_kernel_source(files, "a.cl"),
              "#line 1 \"a.cl\"\none\n#line 1 \"lib/b.h\"\nb one\nb two\n"
              "#line 3 \"a.cl\"\nthree\n");
}

TEST(KernelSource, AFileIsExpandedOnce) {
    const KernelFiles files = {{"a.cl", "#include \"b.h\"\n#include \"c.h\"\n#include \"b.h\"\nlast\n"},
                               {"b.h", "text of b\n"},
                               {"c.h", "#include \"b.h\"\ntext of c\n"}};
    const std::string text = expand_kernel_source(files, "a.cl");
    EXPECT_EQ(occurrences(text, "text of b"), 1u);
    EXPECT_THAT(text, HasSubstr("#line 1 \"c.h\"\n\ntext of c\n#line 3 \"a.cl\"\n\nlast\n"));
}

TEST(KernelSource, FilesThatIncludeEachOtherEnd) {
    const KernelFiles files = {{"a.h", "#include \"b.h\"\nin a\n"}, {"b.h", "#include \"a.h\"\nin b\n"}};
    EXPECT_EQ(occurrences(expand_kernel_source(files, "a.h"), "in a"), 1u);
}

TEST(KernelSource, IncludesAreRelativeToTheIncluderAndThenToTheRoot) {
    const KernelFiles files = {
        {"d/a.cl", "#include \"x.h\"\n#include \"../e/y.h\"\n  #  include \"e/z.h\" // why\n"},
        {"d/x.h", "beside\n"},
        {"x.h", "at the root\n"},
        {"e/y.h", "up\n"},
        {"e/z.h", "from the root\n"}};
    const std::string text = expand_kernel_source(files, "d/a.cl");
    for (const char* expected : {"beside", "up", "from the root"})
        EXPECT_THAT(text, HasSubstr(expected));
    EXPECT_EQ(occurrences(text, "at the root"), 0u);
}

TEST(KernelSource, ALastLineWithoutEndIsKept) {
    const KernelFiles files = {{"a.cl", "#include \"b.h\"\nend"}, {"b.h", "no line end"}};
    EXPECT_EQ(expand_kernel_source(files, "a.cl"),
              "#line 1 \"a.cl\"\n#line 1 \"b.h\"\nno line end\n#line 2 \"a.cl\"\nend\n");
}

TEST(KernelSource, OtherDirectivesAndUnfinishedIncludesAreLeftToTheCompiler) {
    const std::string text =
        "#define include \"b.h\"\n#includes \"b.h\"\n#include <b.h>\n#include \"b.h\n#include \"\n";
    EXPECT_EQ(expand_kernel_source({{"a.cl", text}}, "a.cl"), "#line 1 \"a.cl\"\n" + text);
}

TEST(KernelSource, AMissingFileNamesTheIncluderAndTheLine) {
    const KernelFiles files = {{"a.cl", "#include \"d/b.h\"\n"}, {"d/b.h", "\n\n#include \"gone.h\"\n"}};
    const std::string message = refusal(files, "a.cl");
    EXPECT_THAT(message, HasSubstr("d/b.h:3: "));
    EXPECT_THAT(message, HasSubstr("\"gone.h\""));
    EXPECT_THAT(refusal(files, "no.cl"), HasSubstr("no.cl: there is no kernel file of this name"));
}

TEST(KernelSource, EmbeddedFilesAreTheFilesOfTheKernelsFolder) {
    const KernelFiles in_folder = read_kernel_files(CLRT_KERNELS_FOLDER);
    for (const auto& [file, text] : in_folder) {
        ASSERT_TRUE(embedded_kernel_files().count(file)) << file << " is not embedded";
        EXPECT_EQ(embedded_kernel_files().at(file), text) << file;
    }
    EXPECT_EQ(embedded_kernel_files().size(), in_folder.size());
}

// A file is expanded where it is first included. Were that under a condition that is false, it would be
// nowhere.
TEST(KernelSource, WhatIsIncludedUnderAConditionIsIncludedNowhereElse) {
    std::map<std::string, int> includes;
    std::set<std::string> conditional;
    for (const auto& [file, text] : embedded_kernel_files()) {
        std::istringstream lines(text);
        int depth = file.substr(file.size() - 2) == ".h" ? -1 : 0; // the include guard is no condition
        for (std::string line; std::getline(lines, line);) {
            depth += line.rfind("#if", 0) == 0 ? 1 : line.rfind("#endif", 0) == 0 ? -1 : 0;
            if (line.rfind("#include \"", 0) != 0)
                continue;
            const std::string name = line.substr(line.find_last_of("/\"", line.size() - 2) + 1);
            ++includes[name];
            if (depth > 0)
                conditional.insert(name);
        }
    }
    EXPECT_FALSE(conditional.empty());
    for (const std::string& name : conditional)
        EXPECT_EQ(includes[name], 1) << name;
}

TEST_F(KernelFolder, KernelFilesAreReadFromAllLevels) {
    write("a.cl", "entry");
    write("deep/er/b.h", "header\n");
    write("notes.txt", "no kernel");
    EXPECT_EQ(read_kernel_files(folder_.string()),
              (KernelFiles{{"a.cl", "entry"}, {"deep/er/b.h", "header\n"}}));
    EXPECT_EQ(read_kernel_files(folder_.string() + "/").count("deep/er/b.h"), 1u);
}

TEST_F(KernelFolder, FoldersWithoutKernelFilesAreRefused) {
    EXPECT_THROW(read_kernel_files(folder_.string()), SceneError);
    EXPECT_THROW(read_kernel_files((folder_ / "absent").string()), SceneError);
}
