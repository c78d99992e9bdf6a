// SPDX-License-Identifier: Apache-2.0
// The text of --help. Layout: headings end in ':' at the left edge, entries start two columns in, their text
// at TEXT_COLUMN; tools/manpage.py reads this layout.
#include "app/help_text.h"

#include "app/option_table.h"
#include "exit_code.h"
#include "scene/readers/reader_table.h"

#include <sstream>
#include <utility>
#include <vector>

namespace clrt {

namespace {

constexpr size_t TEXT_COLUMN = 31, EXIT_TEXT_COLUMN = 7;

/// Appends `name` and behind it the text, wrapped from column `indent` to column `columns`.
void append_entry(std::string& page, const std::string& name, const std::string& text, size_t indent,
                  size_t columns) {
    std::string line = name;
    if (name.size() + 2 > indent) { // two blanks tell a name from its text
        page += name + "\n";
        line.clear();
    }
    line.resize(indent, ' ');
    std::istringstream words(text);
    bool first_word = true;
    for (std::string word; words >> word; first_word = false) {
        if (line.size() + 1 + word.size() > columns) {
            page += line + "\n";
            line.assign(indent, ' ');
            first_word = true;
        }
        line += (first_word ? "" : " ") + word;
    }
    page += line + "\n";
}

std::string entry_name(const OptionSpec& spec) {
    const std::string short_part =
        spec.short_name[0] ? "  -" + std::string(spec.short_name) + ", " : "      ";
    const std::string value = spec.value_name[0] && spec.value_name[0] != '[' ? " " : "";
    return short_part + spec.long_name + value + spec.value_name;
}

const std::vector<std::pair<ExitCode, const char*>>& exit_codes() {
    static const std::vector<std::pair<ExitCode, const char*>> codes = {
        {EXIT_DONE, "done as asked: every picture is written"},
        {EXIT_SCENE, "scene, input or output file, or host memory"},
        {EXIT_USAGE, "wrong command line or options file"},
        {EXIT_DEVICE, "no such device, its compiler failed, or it lacks memory or fp64"},
        {EXIT_CHECK, "--check strict found samples that are not finite; the picture is written"},
        {EXIT_ERROR_NOT_REACHED,
         "--error or --denoised-error was not reached within --spp and --time; the picture is written"},
        {EXIT_INTERRUPTED, "stopped by Ctrl-C or from the page of --serve; the picture so far is written if "
                           "one pass was complete"},
        {EXIT_TERMINATED, "stopped by SIGTERM; likewise. A second signal stops at once, without a picture"},
    };
    return codes;
}

} // namespace

std::string help_text(size_t columns) {
    std::string page = "Usage: clrt [options] scene.obj\n\n";
    append_entry(
        page, "",
        "Turns " + reader_names() +
            " into a picture on any OpenCL device. What the scene does not say, camera and "
            "light included, is chosen for it and named in the log. The scene - is read from the standard "
            "input: it is called stdin, and what it names is looked for in the current folder.",
        0, columns);
    page += "\nExample:\n"
            "  clrt --device pocl --spp 256 -r 1280x720 -o hall.png -o hall.exr hall.obj\n";
    const char* group = "";
    for (const OptionSpec& spec : option_table()) {
        if (std::string(group) != spec.group)
            page += std::string("\n") + (group = spec.group) + ":\n";
        append_entry(page, entry_name(spec), spec.help, TEXT_COLUMN, columns);
    }
    page += "\nOptions file:\n";
    append_entry(
        page, "",
        "SCENE.clrt beside SCENE.obj holds options for that scene: one long option a line with its dashes, "
        "its value after a blank; a line that starts with # is a comment. Relative paths count from the "
        "file's folder. The command line wins.",
        2, columns);
    page += "\nExit codes:\n";
    for (const auto& [code, meaning] : exit_codes())
        append_entry(page, "  " + std::to_string(code), meaning, EXIT_TEXT_COLUMN, columns);
    return page;
}

std::string version_text() {
    return "clrt " CLRT_VERSION "\n";
}

} // namespace clrt
