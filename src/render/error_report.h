// SPDX-License-Identifier: Apache-2.0
// What is known about a picture's error, as JSON and metadata (error_text.h: in words).
#pragma once

#include "film/error_slope.h"
#include "film/error_spread.h"
#include "film/film_error.h"
#include "output/image.h"
#include "render/cut_paths.h"
#include "render/error_price.h"
#include "render/unmet_light.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace clrt {

/// The error of a film with all that belongs to it.
struct ErrorReport {
    ErrorMeasure measure = ErrorMeasure::MSE; ///< by which --error judges, and of all but other_error
    std::optional<FilmError> error;           ///< over the pixels that show the scene (ErrorPixels::SCENE)
    std::optional<FilmError> other_error;     ///< by the other measure
    std::optional<FilmError> whole_error;     ///< over all pixels
    std::optional<double> scene_share; ///< of the pixels: shows the scene; none where that is not known
    bool has_backdrop = false;         ///< whether the two errors are of different pixels
    std::optional<ErrorSlope> slope;
    std::optional<ErrorSpread> spread;
    std::optional<ErrorPrice> price;        ///< of half the error
    std::optional<ErrorPrice> target_price; ///< of the error that is asked for, where it is not reached
    CutPaths cut;                           ///< what the error does not hold: light of paths that were cut,
    std::vector<BlindSpot> blind_spots;     ///< of paths that are never sampled,
    std::optional<UnmetLight> unmet;        ///< and of paths so rare that none may have been sampled
    int replicates = 0;                     ///< with samples
    int window_x = 0, window_y = 0;         ///< the window's place in the whole picture
};

/// Makes the report of a render; (x, y) is the window's top left pixel in the whole picture, `target` the
/// error that is asked for.
ErrorReport make_error_report(const RenderProgress& render, const BiasSources& bias, int x, int y,
                              const std::optional<double>& target = {});

/// What the error is worth.
enum class Verdict {
    NONE,       ///< there is no error
    TRUSTED,    ///< it holds all that is wrong with the picture
    INCOMPLETE, ///< it holds what was sampled; paths are cut, never sampled, or too rare
    UNTRUSTED   ///< bright samples decide it that single replicates saw: ErrorSpread::usable()
};
Verdict verdict_on(const ErrorReport& report);
/// Its name in the JSON: "none", "trusted", "incomplete", "untrusted".
const char* verdict_name(Verdict verdict);

/// Whether the error holds all that is wrong with the picture.
bool is_complete(const ErrorReport& report);

/// A price in the JSON.
nlohmann::ordered_json price_json(const ErrorPrice& price);

/// The JSON's "error".
nlohmann::ordered_json error_report_json(const ErrorReport& report);

/// The same facts as metadata.
void add_error_metadata(const ErrorReport& report, Metadata& metadata);

} // namespace clrt
