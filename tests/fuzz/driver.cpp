// SPDX-License-Identifier: Apache-2.0
// The fuzz driver of the test suite: replays a corpus, then tries mutations of it; the same numbers in every
// run.
//
//   TARGET_fuzz [--runs N] [--seed N] [--dictionary FILE] [--keep FOLDER] INPUT...
//
// An input is a file or a folder of files. An input that ends the process is kept as FOLDER/crash-SEED-RUN
// (default: the current folder); giving it back as INPUT repeats it.
#include "fuzz_target.h"

#include <algorithm>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <random>
#include <sanitizer/common_interface_defs.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace clrt {

namespace {

namespace fs = std::filesystem;

struct Settings {
    std::uint64_t runs = 0, seed = 1;
    std::string keep = ".";
    std::vector<std::string> corpus, words;
};

std::string read_bytes(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The words in double quotes of libFuzzer's dictionaries: one a line, \\, \" and \xNN escaped.
std::vector<std::string> read_dictionary(const std::string& path) {
    std::vector<std::string> words;
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
        const size_t begin = line.find('"'), end = line.rfind('"');
        if (line.empty() || line[0] == '#' || begin >= end)
            continue;
        std::string word;
        for (size_t i = begin + 1; i < end; ++i) {
            if (line[i] == '\\' && line[i + 1] == 'x') {
                word += char(std::stoi(line.substr(i + 2, 2), nullptr, 16));
                i += 3;
            } else
                word += line[i] == '\\' ? line[++i] : line[i];
        }
        words.push_back(word);
    }
    return words;
}

void add_inputs(const fs::path& path, std::vector<std::string>& corpus) {
    if (!fs::is_directory(path))
        return corpus.push_back(read_bytes(path));
    std::vector<fs::path> files{fs::directory_iterator(path), fs::directory_iterator()};
    std::sort(files.begin(), files.end()); // the same order on every file system
    for (const fs::path& file : files)
        corpus.push_back(read_bytes(file));
}

Settings read_settings(int argc, char** argv) {
    Settings settings;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.compare(0, 2, "--") != 0) {
            add_inputs(word, settings.corpus);
            continue;
        }
        const std::string value = i + 1 < argc ? argv[++i] : "";
        if (word == "--runs")
            settings.runs = std::stoull(value);
        else if (word == "--seed")
            settings.seed = std::stoull(value);
        else if (word == "--dictionary")
            settings.words = read_dictionary(value);
        else if (word == "--keep")
            settings.keep = value;
    }
    settings.keep = fs::absolute(settings.keep).string(); // targets may change the current folder
    return settings;
}

/// Changes inputs at random, all from one seed.
class Mutator {
public:
    explicit Mutator(const Settings& settings) : settings_(settings), random_(settings.seed) {}

    /// A corpus entry after one to eight changes.
    std::string next() {
        std::string input = any(settings_.corpus);
        for (size_t changes = 1 + below(8); changes > 0; --changes)
            change(input);
        if (input.size() > LONGEST_INPUT)
            input.resize(LONGEST_INPUT);
        return input;
    }

private:
    static constexpr size_t LONGEST_INPUT = 4096;

    size_t below(size_t limit) { return limit ? size_t(random_() % limit) : 0; }
    template <typename T>
    const T& any(const std::vector<T>& values) {
        return values[below(values.size())];
    }
    /// A piece of at most 64 bytes: where it begins and how long it is.
    std::pair<size_t, size_t> piece(const std::string& text) {
        const size_t begin = below(text.size() + 1);
        return {begin, below(std::min<size_t>(64, text.size() - begin) + 1)};
    }

    void change(std::string& input) {
        static const std::vector<std::string> NUMBERS = {
            "0", "-1", "1e38", "-1e-46", "1e400",       "nan",  "-inf",  "2147483648", "0.5",
            "+", ".",  "1e",   "-0",     "-2147483649", "9e99", "65536", "1/2/3",      "4294967296"};
        const auto [begin, size] = piece(input);
        switch (below(9)) {
        case 0: // Flip a bit.
            if (!input.empty())
                input[below(input.size())] ^= char(1u << below(8));
            break;
        case 1: // Set a byte.
            if (!input.empty())
                input[below(input.size())] = char(below(256));
            break;
        case 2: // Take a piece out,
            input.erase(begin, size);
            break;
        case 3: // double it,
            input.insert(below(input.size() + 1), input.substr(begin, size));
            break;
        case 4: // or put one of another input in.
            if (const std::string other = any(settings_.corpus); !other.empty()) {
                const auto [from, count] = piece(other);
                input.insert(begin, other.substr(from, count));
            }
            break;
        case 5: // Put a word in,
            if (!settings_.words.empty())
                input.insert(begin, any(settings_.words));
            break;
        case 6: // or in place of a piece.
            if (!settings_.words.empty())
                input.replace(begin, size, any(settings_.words));
            break;
        case 7:
            replace_number(input, any(NUMBERS));
            break;
        default: // Cut the end off.
            input.resize(below(input.size() + 1));
        }
    }

    /// Puts a number in place of the first one after a random place.
    void replace_number(std::string& input, const std::string& number) {
        const size_t begin = input.find_first_of("0123456789", below(input.size() + 1));
        if (begin == input.npos)
            return;
        const size_t end = std::min(input.find_first_not_of("0123456789.eE+-", begin), input.size());
        input.replace(begin, end - begin, number);
    }

    const Settings& settings_;
    std::mt19937_64 random_;
};

/// The input that is being tried, for keep_input() after a finding.
struct Trial {
    std::string input, keep_as;
};

Trial& trial() {
    static Trial current;
    return current;
}

/// Called by the sanitizers when the process must end.
void keep_input() {
    const int file = open(trial().keep_as.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0666);
    const ssize_t written = file < 0 ? -1 : write(file, trial().input.data(), trial().input.size());
    std::fprintf(stderr, "the input of %zu bytes %s %s\n", trial().input.size(),
                 written < 0 ? "cannot be kept as" : "is kept as", trial().keep_as.c_str());
}

void run(const Settings& settings, std::uint64_t number, std::string input) {
    trial() = {std::move(input),
               settings.keep + "/crash-" + std::to_string(settings.seed) + "-" + std::to_string(number)};
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(trial().input.data()), trial().input.size());
}

} // namespace

} // namespace clrt

/// Aborts are findings too: a broken promise, an assertion, an exception of the wrong kind. Leaks are
/// libFuzzer's to find: looking for them takes a right to trace that containers withhold.
extern "C" const char* __asan_default_options() {
    return "handle_abort=1:detect_stack_use_after_return=1:detect_leaks=0";
}

int main(int argc, char** argv) {
    using namespace clrt;
    const Settings settings = read_settings(argc, argv);
    if (settings.corpus.empty()) {
        std::fprintf(stderr, "expected inputs, found none\n");
        return 2;
    }
    __sanitizer_set_death_callback(keep_input);
    for (size_t i = 0; i < settings.corpus.size(); ++i)
        run(settings, i, settings.corpus[i]);
    Mutator mutator(settings);
    for (std::uint64_t i = 0; i < settings.runs; ++i)
        run(settings, settings.corpus.size() + i, mutator.next());
    std::printf("%zu inputs of the corpus and %llu mutations\n", settings.corpus.size(),
                static_cast<unsigned long long>(settings.runs));
}
