// SPDX-License-Identifier: Apache-2.0
// From work-item to pixel: a work-group is a tile of 8 x 8 pixels. Consecutive groups are spread over the picture, because a
// CPU thread takes a run of them and a run should cost what the picture costs on average.
#ifndef CLRT_FILM_TILE_H
#define CLRT_FILM_TILE_H

#include "shared/render_types.h"

#define TILE_SIZE 8

/* The pixel of this work-item within the window; false for padding. */
static inline bool tile_pixel(const RenderParams* params, uint2* pixel)
{
    const uint group = params->first_tile + (uint)(get_group_id(1) * get_num_groups(0) + get_group_id(0));
    if (group >= params->end_tile)
        return false;
    const uint tile = (uint)(((ulong)group * params->tile_stride) % params->tile_count);
    pixel->x = (tile % params->tiles_x) * TILE_SIZE + (uint)get_local_id(0);
    pixel->y = (tile / params->tiles_x) * TILE_SIZE + (uint)get_local_id(1);
    return pixel->x < params->crop_width && pixel->y < params->crop_height;
}

#endif
