// SPDX-License-Identifier: Apache-2.0
// --denoise of a finished render, and what is said of it.
#pragma once

#include "output/image.h"
#include "render/render.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clrt {

struct Options;

/// Looks for the library that --denoise names, before any work is done. Throws UsageError where it is asked
/// for by name and is not there.
void check_denoiser(const Options& options);

/// Denoises the render as the options ask, into Render::denoised. A picture that cannot be denoised is
/// written all the same: why not is said and kept in Render::denoise_error.
void denoise_render(const Device& device, const Options& options, Progress& progress, Render& render);

/// "denoised denoising lowers the error from 21.0 % to 6.0 %; ..." in lines; empty where nothing is denoised.
/// `is_untrusted`: the error of the raw picture is not to be trusted, and so neither is this one; no interval
/// is said then.
std::string format_denoised(const Render& render, bool is_untrusted);

/// The JSON's "denoised"; null where nothing is.
nlohmann::ordered_json denoised_json(const Render& render, bool is_untrusted);

/// The same facts as metadata.
void add_denoised_metadata(const Render& render, Metadata& metadata);

} // namespace clrt
