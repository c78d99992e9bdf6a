// SPDX-License-Identifier: Apache-2.0
// Film files -> pictures, without the scene.
#pragma once

#include "film/film_file.h"
#include "output/image.h"

namespace clrt {

/// The picture of a film: radiance, variance and samples, with what is known as metadata.
Picture film_picture(const FilmFile& film);

} // namespace clrt
