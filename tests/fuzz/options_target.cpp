// SPDX-License-Identifier: Apache-2.0
// The command line and the options file: any text gives options or an error of the right kind. Lines are the
// words of a command line; an input that starts with '#' is the options file of a scene.
#include "app/command_line.h"
#include "error.h"
#include "fuzz_target.h"

#include <unistd.h>

namespace clrt {

namespace {

std::vector<std::string> split_lines(std::string_view text) {
    std::vector<std::string> lines{"clrt"};
    while (!text.empty()) {
        const size_t end = text.find('\n');
        // argv ends a word at its first zero byte.
        lines.push_back(std::string(text.substr(0, end)).c_str());
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
    }
    return lines;
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    static const bool inside = chdir(fuzz_folder().file("").c_str()) == 0; // relative names lead nowhere else
    promise(inside, "the scratch folder can be entered");
    const std::string_view text = as_text(data, size);
    const bool is_file = !text.empty() && text.front() == '#';
    if (is_file)
        fuzz_folder().write("a.clrt", std::string(text));
    const std::vector<std::string> words =
        is_file ? std::vector<std::string>{"clrt", "a.obj"} : split_lines(text);
    std::vector<const char*> argv;
    for (const std::string& word : words)
        argv.push_back(word.c_str());
    argv.push_back(nullptr);
    try {
        parse_command_line(int(words.size()), argv.data());
    } catch (const UsageError& error) {
        const std::string_view what = error.what();
        promise(!is_file || what.substr(0, 7) == "a.clrt:" || what.find("option") != what.npos,
                "errors of an options file name it or an option");
    } catch (const SceneError&) {
    }
    if (is_file)
        unlink("a.clrt");
    return 0;
}
