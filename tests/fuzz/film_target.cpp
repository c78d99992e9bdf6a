// SPDX-License-Identifier: Apache-2.0
// Film files: any header gives a sound film or a SceneError. The input is the header's text; lengths and
// checksum are put right, so that what is behind them is met too.
#include "error.h"
#include "film/film_file.h"
#include "fuzz_target.h"

#include <algorithm>
#include <xxhash.h>

namespace clrt {

namespace {

/// A film file with this header, whatever it says, and sums of 1 for a film of `sums` values.
std::string film_bytes(std::string_view header, size_t sums) {
    std::string bytes = "CLRTFILM";
    for (const size_t number : {size_t(2), header.size()})
        for (int i = 0; i < 4; ++i)
            bytes += char(number >> (8 * i) & 0xff);
    bytes += header;
    for (size_t i = 0; i < sums; ++i)
        bytes.append("\1\0\0\0\0\0\0\0", 8);
    XXH128_canonical_t checksum;
    XXH128_canonicalFromHash(&checksum, XXH3_128bits(bytes.data(), bytes.size()));
    return bytes.append(reinterpret_cast<const char*>(checksum.digest), sizeof checksum.digest);
}

void check(const Film& film) {
    promise(film.width > 0 && film.height > 0 && film.replicates > 0, "a film has pixels and replicates");
    promise(film.sums.size() == size_t(film.replicates) * film_plane(film), "a film has all its sums");
    promise(film_samples(film) > 0, "a film has samples");
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    constexpr size_t SUMS = 2 * 2 * 2 * 3; // of the film in the corpus: two replicates of 2 x 2 pixels
    const std::string path = fuzz_folder().write("a.film", film_bytes(as_text(data, size), SUMS));
    try {
        read_film_origin(path);
    } catch (const SceneError&) {
    }
    try {
        check(read_film_file(path).render.film);
    } catch (const SceneError&) {
    }
    return 0;
}
