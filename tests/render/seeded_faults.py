#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Shows that the tests can fail: puts one fault after the other into a copy of the kernels and runs the test that must
catch it.

    tests/render/seeded_faults.py BUILD_FOLDER [NAME...]
    tests/render/seeded_faults.py BUILD_FOLDER --quick

Without names: all faults, each against its whole test program. --quick, which the test suite runs: the faults of QUICK, each
against the one test that catches it, after that test has passed without the fault; and DRAWN of the others, each against
the test of CAUGHT_BY in the same way, else against its test program up to the first test that fails. Those are drawn by a
hash of the kernels: the same for the same kernels, others after every change. With the variable CLRT_TEST_LONG set (the
night tier), all of them. Prints which tests caught each fault; exit code 1 if one was not caught, if its text is no longer
in the kernels, or if the kernels with the fault do not compile."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile

from fault_catchers import CAUGHT_BY, QUICK

KERNELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "kernels")

# Name, file, text, text with the fault, test program.
FAULTS = [
    ("both halves of an adaptive render are one", "film/tile.h",
     "counter.replicate = params->first_replicate + first % params->dealt_replicates;",
     "counter.replicate = first % params->dealt_replicates;", "adaptive_render_test"),
    ("an adaptive tile starts over", "film/tile.h", "range.first = ranges[TILE_RANGE_FIRST];", "range.first = 0u;",
     "adaptive_render_test"),
    ("dropped cosine", "scattering/bsdf_matte.h", "(fmax(wi.z, REAL(0.0)) * REAL_INVERSE_PI)",
     "(wi.z > REAL(0.0) ? REAL_INVERSE_PI : REAL(0.0))", "direct_light_test"),
    ("missing 1/p in roulette", "path/walk.h", "path->throughput /= survival;", "", "furnace_test"),
    ("MIS weights do not sum to 1", "numerics/mis.h", "fma(ratio, ratio, REAL(1.0))", "fma(ratio, ratio, REAL(1.1))",
     "direct_light_test"),
    ("sampled discs counted twice", "lights/lights.h", "* mis_weight(pdf_w, light_pdf_w);\n    }", ";\n    }", "direct_light_test"),
    ("lamp density off by the share of its kind", "lights/light_choice.h",
     "v / emitter, emitter * (real)scene->emitters[chosen].pdf_a", "v / emitter, (real)scene->emitters[chosen].pdf_a",
     "light_sampler_test"),
    ("light density off by the count", "lights/light_choice.h", "light * (real)scene->lights[chosen].probability", "light",
     "light_sampler_test"),
    ("a lamp met by chance as if tables chose it", "lights/light_choice.h",
     """    if (light_choice_is_by_tree(params))
        return light_tree_probability(light_tree_width(scene, view, emitter)) *
               (real)scene->light_places[emitter].density;
""", "", "light_sampler_test"),
    ("parts of lamps met by chance are the first", "geometry/emitter_part.h", "= emitter_part_digits(b1, b2);", "= 0u;", "emitter_part_test"),
    ("guided directions without the guide's density", "path/guide.h",
     "next.weight = value.value / mixture;", "next.weight = value.value / value.pdf_w;", "guide_test"),
    ("directions of the BSDF as if nothing were guided", "path/guide.h", "    next.weight /= guide->ratio;\n", "", "guide_test"),
    ("a guide's gain without its directions", "path/guide_gain.h", "gain->ratio * ratio;", "gain->ratio;", "guide_test"),
    ("a guide's gain without its roulette", "path/guide_gain.h",
     "    gain->next_ratio *= survival / roulette_survival(size * gain->next_ratio);\n", "", "guide_test"),
    ("missing eta^2, smooth glass", "scattering/bsdf_dielectric.h", "bsdf->transmission * bsdf_cross(bsdf, REAL(1.0))",
     "bsdf->transmission", "furnace_test"),
    ("missing eta^2, whitted", "integrators/tree.h", "bsdf_cross(bsdf, REAL(1.0) - f)", "(REAL(1.0) - f)", "glass_test"),
    ("shadow ray not traced", "path/visibility.h", "while (vector_max_component(passage.share) > REAL(0.0)) {", "while (false) {",
     "direct_light_test"),
    ("the plane's normal for shading", "scattering/material.h", "real3 n = surface->normal_s;",
     "real3 n = surface->normal_g;", "shading_normal_test"),
    ("maps decide sides", "scattering/bsdf.h", "return bsdf_reflects(bsdf, wi_world) == (wi.z > REAL(0.0));", "return true;",
     "surface_sides_test"),
    ("rounded normals make a wall curved", "geometry/surface.h", "if (nearest >= SURFACE_FLAT_COS)", "if (false)", "surface_test"),
    ("parts of a BSDF shine through", "path/filter.h", "accepting == FILTER_LETTERS || vector_is_black(whole)",
     "accepting == FILTER_LETTERS", "surface_sides_test"),
    ("walls that edges hide are hit", "path/visibility.h", "nearer.triangle == NO_INDEX ||", "true ||", "surface_sides_test"),
    ("sampler address used for all bounces", "numerics/sampler.h", "return bounce * SAMPLER_PURPOSES + purpose;",
     "return purpose;", "interreflection_test"),
    ("lobe and roulette share a number", "path/walk.h", "!(sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival)",
     "!(path->numbers.lobe >= survival)", "furnace_test"),
    ("lobe and direction share a number", "path/numbers.h", "sampler_partner_words(sampler, bounce, SAMPLE_DIRECTION)",
     "sampler_pair_words(sampler, bounce, SAMPLE_DIRECTION)", "furnace_test"),
    ("film and light sample share a pair", "numerics/sampler.h", "return sampler_words(sampler, address, is_first);",
     "return sampler_words(sampler, address, false);", "sampler_test"),
    ("filter offset", "camera/camera.h", "(u - (real2)(REAL(0.5)))", "u", "pixel_filter_test"),
    ("front and back of lamps swapped", "scattering/material.h", "return front ||", "return !front ||", "direct_light_test"),
    ("tent filter as a box", "camera/camera.h", "(real2)(camera_tent(u.x), camera_tent(u.y))",
     "(REAL(2.0) * u - (real2)(REAL(1.0)))", "pixel_filter_test"),
    ("a pinhole's importance without one cosine", "camera/camera_perspective.h", "(area * cosine * cosine * cosine)",
     "(area * cosine * cosine)", "camera_test"),
    ("a splat's density without the distance", "camera/camera_perspective.h", "/ (distance * distance)", "", "camera_test"),
    ("film positions of projected points not over their depth", "camera/camera_perspective.h",
     "camera_film_position(camera, way) / depth", "camera_film_position(camera, way)", "camera_test"),
    ("parallel rays start in the eye", "camera/camera_orthographic.h", "return ray_make(origin,",
     "return ray_make(vector_from(camera->eye),", "orthographic_test"),
    ("the lens stands in one point", "camera/camera_perspective.h", "origin += camera_film_offset(camera, point);", "",
     "camera_lens_test"),
    ("the plane in focus is off by a hundredth", "camera/camera_perspective.h", "film -= point * (real)camera->inverse_focus;",
     "film -= point * (REAL(1.01) * (real)camera->inverse_focus);", "camera_lens_test"),
    ("a lens as wide as its radius", "camera/camera_lens.h", "(real)camera->lens_radius / pixel",
     "(REAL(0.5) * (real)camera->lens_radius) / pixel", "lens_test"),
    ("lens and film share a pair", "camera/camera.h", "sampler_pair(sampler, 0u, SAMPLE_LENS)",
     "sampler_pair(sampler, 0u, SAMPLE_FILM)", "lens_test"),
    ("blades that lie unevenly", "camera/camera_lens.h", "const real2 weights = warp_triangle(", "const real2 weights = (real2)(REAL(0.5)) * (",
     "camera_lens_test"),
    ("a splat through another point of the lens", "camera/camera_perspective.h",
     "connection.film += place * (real)camera->inverse_focus;", "", "camera_lens_test"),
    ("a panorama's poles weigh like its equator", "camera/camera_equirectangular.h",
     "(camera_panorama_area(camera) * fmax(cosine, REAL_ROUNDING))", "camera_panorama_area(camera)", "camera_test"),
    ("latitudes by their sines", "camera/camera_equirectangular.h", "camera_sin_cos(film.y * (real)camera->pixel_y)",
     "(real2)(film.y * (real)camera->pixel_y * REAL(4.0), real_root(REAL(1.0) - REAL(16.0) * film.y * film.y * "
     "(real)camera->pixel_y * (real)camera->pixel_y))", "panorama_test"),
    ("a fisheye whose pixels are alike", "camera/camera_fisheye.h", "(sine > REAL(0.0) ? angle / sine : REAL(1.0))", "REAL(1.0)",
     "camera_test"),
    ("a picture shifted the other way", "camera/camera.h", "film + camera_shift(camera)", "film - camera_shift(camera)",
     "camera_lens_test"),
    ("the camera moves to the end at once", "camera/camera_motion.h", "camera_moved(camera->eye, camera->eye_move, time)",
     "camera_moved(camera->eye, camera->eye_move, REAL(1.0))", "shutter_test"),
    ("the camera turns to the end at once", "camera/camera_motion.h", "camera_moved(camera->way, camera->way_move, time)",
     "camera_moved(camera->way, camera->way_move, REAL(1.0))", "camera_motion_test"),
    ("triangles of blocks stand still", "geometry/traverse_bvh8.h", "bvh8_move(scene, words, time, corners);", ";",
     "moving_scene_test"),
    ("triangles of narrow trees stand still", "geometry/leaf_triangle.h", "const real time = ray_time(ray);",
     "const real time = REAL(0.0);", "moving_scene_test"),
    ("points of triangles that move lie where they were", "geometry/surface.h", "const real time = ray_time(ray);\n",
     "const real time = REAL(0.0);\n", "moving_scene_test"),
    ("normals that turn are too short", "geometry/surface.h", "n[i] = length > REAL(0.0) ? n[i] / length : n[i];", "",
     "moving_scene_test"),
    ("corner normals stand still", "geometry/surface.h",
     "surface_moved(scene, scene->normals, scene->normal_moves, triangle->n0, time)",
     "vector_from(scene->normals[triangle->n0])", "moving_scene_test"),
    ("rays from a surface forget the time", "geometry/surface.h", "direction, surface_time(surface))",
     "direction, REAL(0.0))", "ray_time_test"),
    ("no p-polarised part of Fresnel", "scattering/fresnel.h", "REAL(0.5) * fma(s, s, p * p)", "s * s", "glass_test"),
    ("indices of glass swapped", "scattering/material.h", "from_air ? other / index : index / other",
     "from_air ? index / other : other / index", "glass_test"),
    ("a colour counts once", "scattering/dispersion.h", ": REAL(3.0);", ": REAL(1.0);", "dispersion_test"),
    ("both ends drop colours", "path/bdpt_connect.h", "connection->light /= REAL(3.0);", "", "dispersion_test"),
    ("paths from both ends of colours of their own", "path/light_path.h", "light_path_join(&eye, &path);", "", "dispersion_test"),
    ("colours reflected as the wave's", "scattering/dispersion.h", "dispersion_reflects(bsdf, cos_o);", "(real3)(REAL(1.0));",
     "dispersion_test"),
    ("no surface within a solid is passed", "path/visibility.h", "return nest_is_alike(scene", "return false && nest_is_alike(scene",
     "nested_test"),
    ("solids of lamps unknown", "path/light_path.h", "HAS(EFFECT_NESTED) && !path->emission", "false && !path->emission", "nested_test"),
    ("a glossy sample below ends in the glass", "scattering/bsdf_glossy.h",
     "if (bsdf_is_part_glass(bsdf) && !(wi.z > REAL(0.0)))", "if (false)", "bsdf_energy_test"),
    ("covers that vary apart", "scattering/bsdf_cover.h",
     "coat_schlick * below * COVER_SCHLICK_VARIANCE * sheen_left", "REAL(0.0)", "bsdf_energy_test"),
    ("a pane bends importance", "scattering/bsdf_reverse.h",
     "if (!(HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE)))", "if (true)", "bsdf_transport_test"),
    ("measured directions told apart", "scattering/bsdf_measured.h", "is_other ? real_atan2", "false ? real_atan2", "bsdf_measured_test"),
    ("a measured density as of halves", "scattering/bsdf_measured.h", "density / (REAL(2.0) * length)", "density", "bsdf_measured_test"),
    ("a cover not seen from the other side", "scattering/bsdf_reverse.h", "reversed.flags ^= BSDF_INSIDE;", ";",
     "bsdf_transport_test"),
    ("a coat over the whole light below", "scattering/bsdf_cover.h",
     "factors.other = cover->coat_shared * cover_coat_shared(bsdf, wi, coat_left) *", "factors.other =", "bsdf_energy_test"),
    ("lamps shine through their coat undimmed", "scattering/material.h",
     "emission *= cover_film_left(coat.x, coat.y, vector_make(sine, REAL(0.0), cosine));", "", "furnace_test"),
    ("sampled lamps below a coat as if seen head-on", "lights/emitter.h",
     "facing / (distance * vector_length(normal)));", "REAL(1.0));", "furnace_test"),
    ("light leaves a coat as if head-on", "lights/emission.h",
     "material_emission(scene, triangle->material, uv, emission.cosine)",
     "material_emission(scene, triangle->material, uv, REAL(1.0))", "light_paths_test"),
    ("fibres denser than their density", "scattering/bsdf_sheen.h", "REAL(0.5) / alpha)", "REAL(1.0) / alpha)", "bsdf_energy_test"),
    ("no tint of crossings", "scattering/bsdf_dielectric.h", "bsdf->transmission * bsdf_cross(bsdf, REAL(1.0))",
     "(real3)(bsdf_cross(bsdf, REAL(1.0)))", "glass_test"),
    ("poles weigh like the equator", "lights/environment.h", "environment_half_sin(params, (real)(2u * from_pole + 1u))", "REAL(0.7)",
     "sky_light_test"),
    ("sky turned the other way", "lights/environment.h",
     "vector_make(fma(c, d.x, -(s * d.z)), d.y, fma(s, d.x, c * d.z))",
     "vector_make(fma(c, d.x, s * d.z), d.y, fma(-s, d.x, c * d.z))", "sky_light_test"),
    ("hits of the sky know nothing of portals", "lights/sky_portal.h",
     "wi, place, portals_weight(scene, params, view));", "wi, place, REAL(0.0));", "portal_choice_test"),
    ("sky that its table leaves to the BSDF is lost", "lights/lights.h",
     "environment_eval_at(scene, params, place) * mis_weight(pdf_w, light_pdf_w);",
     "environment_eval_at(scene, params, place) * mis_weight(pdf_w, light_pdf_w);\n        if (pdf_w > REAL(0.0) && "
     "params->choose_environment > 0.0f && light_pdf_w == REAL(0.0))\n            radiance = (real3)(REAL(0.0));",
     "sky_light_test"),
    ("screens cast no shadow", "path/visibility.h", "passage.share *= crossing.share;", "", "cut_out_test"),
    ("reused through walls", "integrators/path_reuse.h", "visible_passage(scene, params, &shadow)", "open", "path_reuse_test"),
    ("panes do not dim shadow rays", "path/visibility.h", "crossing->share += coverage * passes;",
     "crossing->share = (real3)(REAL(1.0));", "glass_test"),
    ("paths stopped by a pane not weighted", "path/visibility.h", "stops ? (real3)(crossing.coverage / crossing.stop)",
     "stops ? (real3)(REAL(1.0))", "glass_test"),
    ("a tree's ray forgets its way before the pane", "integrators/distribution_ray.h",
     "behind.before = distribution_length(path, hit);", "behind.before = REAL(0.0);", "glass_test"),
    ("solid angle of lamps off by a tenth", "lights/spherical_triangle.h", "REAL(2.0) * real_atan2(",
     "REAL(2.2) * real_atan2(", "direct_light_test"),
    ("lamps hit by chance weighed by area", "lights/emitter.h",
     "            return emitter_pdf_of_angle(pdf_a, normal, seen.solid_angle);", "            {}", "direct_light_test"),
    ("lights are looked at from the plane", "lights/lights.h", "{surface_lifted(surface), normal}",
     "{surface->position, normal}", "light_origin_test"),
    ("lights are looked at from the plane, all of them", "integrators/direct.h",
     "const real3 from = surface_lifted(surface);", "const real3 from = surface->position;", "light_origin_test"),
    ("a light seen from another point keeps its density", "lights/light_sample.h",
     "sample->pdf_w * ratio : REAL(0.0)", "sample->pdf_w : REAL(0.0)", "light_origin_test"),
    ("lamps hit through glass weighed as beside it", "path/connect.h", "&& path->has_crossed_curved", "&& false",
     "light_origin_test"),
    ("cut-out lamps shine in full", "lights/emitter.h", "sample.radiance *= material_coverage(scene, material, uv);", "",
     "cut_out_test"),
    ("textures upside down", "geometry/texture.h", "(1.0f - v) * (float)level->height", "v * (float)level->height",
     "textured_picture_test"),
    ("vertex colours by the wrong weights", "geometry/surface.h", "surface->b1 * (c1 - c0)", "surface->b2 * (c1 - c0)",
     "vertex_colour_test"),
    ("green of normal maps turned round", "scattering/material.h", "m.y * handed * frame.y", "-m.y * handed * frame.y",
     "shading_normal_test"),
    ("strength of normal maps forgotten", "scattering/material.h", "? (real)material->bump_scale : REAL(1.0)",
     "? REAL(1.0) : REAL(1.0)", "mtl_dialects_test"),
    ("no inverse square", "lights/delta_light.h", "sample.radiance /= distance_squared;", "", "direct_light_test"),
    ("a spot's falloff without its square", "lights/delta_light.h", "return share * share;", "return share;", "spot_light_test"),
    ("light paths of spots by the whole cone", "lights/emission.h", "emission->power *= delta_light_falloff(light, w);", ";",
     "light_paths_test"),
    ("one polarisation of metals", "scattering/fresnel.h", "return REAL(0.5) * fma(s, p, s);", "return s;", "furnace_test"),
    ("several facets of metals by their absorption", "scattering/bsdf_energy.h",
     "return fresnel_conductor_mean(bsdf->transmission, bsdf->specular);", "return bsdf->specular;", "furnace_test"),
    ("no masking of microfacets", "scattering/bsdf_glossy.h", "(REAL(1.0) + lambda_o + lambda_i)",
     "(REAL(1.0) + lambda_o)", "furnace_test"),
    ("window not taken from the whole picture", "film/tile.h", "return y * params->width + x;",
     "return (y - params->crop_y) * params->width + x;", "same_bits_test"),
    ("indices of 32 bits", "film/tile.h", "return (ulong)words * slot;", "return words * slot;", "film_tile_test"),
    ("mirrors show the background", "lights/lights.h", "segment > 1u || BACKGROUND_IS_SEEN(*params)",
     "BACKGROUND_IS_SEEN(*params)", "background_test"),
    ("the background is of every kind of light", "lights/lights.h", "(kinds & KIND_SKY) ? vector_from(params->background)",
     "true ? vector_from(params->background)", "background_test"),
    ("layers start over", "integrators/aov.cl", "sample_counter_make(&params, range.first)",
     "sample_counter_make(&params, 0u)", "hit_layers_test"),
    ("mattes forget what has a slot", "film/matte.h", "if (slot[MATTE_SAMPLES] == 0u)", "if (i == 0u)", "hit_layers_test"),
    ("squared index kept for importance", "scattering/bsdf_types.h",
     "return (bsdf->flags & TRANSPORT_IMPORTANCE) ? x : x * bsdf->eta * bsdf->eta;",
     "return x * bsdf->eta * bsdf->eta;", "light_paths_test"),
    ("shading normals forgotten where light paths go on", "scattering/bsdf.h",
     "sample.weight *= bsdf_shading_factor(bsdf, sample.wi, wi);", ";", "bsdf_transport_test"),
    ("shading normals forgotten where light paths meet the camera", "scattering/bsdf.h",
     "sum.value *= bsdf_shading_factor(bsdf, wi_world, wi);", ";", "light_paths_test"),
    ("splats over the light paths of the window", "path/splat_weight.h", "return (real)params->light_path_count;",
     "return (real)params->crop_width * (real)params->crop_height;", "light_paths_test"),
    ("light paths of the window alone", "integrators/light_paths.h", "path += of_window", "path += of_pass", "light_paths_test"),
    ("both sides of a lamp get all light paths", "lights/emission_pdf.h",
     "(scene->materials[material].flags & MATERIAL_EMITS_BOTH_SIDES) ? REAL(0.5) : REAL(1.0)", "REAL(1.0)", "light_paths_test"),
    ("distant light through a smaller disc", "lights/emission.h", "frame.y + wi) * (real)params->emission_radius;",
     "frame.y + wi) * ((real)params->emission_radius * REAL(0.5));", "light_paths_test"),
    ("a splat's filter twice", "camera/camera_splat.h", "splat.weight = sum / camera_filter_integral(params);",
     "splat.weight = sum / camera_filter_integral(params) * sum;", "light_paths_test"),
    ("a ray aimed at two casters counts once", "lights/emission_aim.h", "            height += target.height;",
     "            height = fmax(height, target.height);", "light_paths_test"),
    ("casters below a lamp's plane take part of its rays", "lights/emission_aim.h", "        measure += target.measure;",
     "        measure += target.measure > REAL(0.0) ? target.measure : REAL(1.0);", "light_paths_test"),
    ("parallel rays aimed at two casters count once", "lights/emission_aim.h", "return (real)met *", "return (real)min(met, 1u) *",
     "light_paths_test"),
    ("aimed parallel rays keep the whole scene's disc", "lights/emission_pdf.h",
     "return EMISSION_IS_AIMED ? aim_disc_pdf_a(scene, params, point, w) : emission_disc_pdf_a(params);",
     "return emission_disc_pdf_a(params);", "light_paths_test"),
    ("matte surfaces pass on light that is aimed at casters", "path/light_path.h",
     "(light_path_is_at_caster(segment) ||", "(", "light_paths_test"),
    ("next-event estimation's density from another vertex", "path/splat_weight.h",
     "const real3 way = view->position - emission->point;",
     "const real3 way = emission->ray.direction;", "bdpt_test"),
    ("light paths find what connections through slabs do", "path/light_path.h",
     "return slab_is_behind(params, &path->slabs, path->emission.ray.direction, path->ray.direction) &&",
     "return false &&", "slab_test"),
    ("connections through slabs weighed against light paths", "path/connect.h",
     "    path->connection /= path->connects_with_others;\n", "", "slab_test"),
    ("slabs reflect nothing of what is connected through them", "path/slab.h", " * (REAL(1.0) - f);", ";", "slab_test"),
    ("light met through slabs not weighed against connections", "path/walk.h",
     "    path->pdf_w = path->pdf_w_before_slabs;\n", "", "slab_test"),
    ("light bent by slabs taken for what it was", "path/slab.h",
     "vector_dot(turn, turn) <= SLAB_LARGEST_TURN * SLAB_LARGEST_TURN &&", "", "slab_test"),
    ("roulette in the weights of light paths", "path/light_path.h", "path->throughput /= survival;",
     "path->throughput /= survival;\n    path->weights.closed *= survival;\n    path->weights.open *= survival;",
     "bdpt_test"),
    ("connections behind a delta lobe weighed", "path/splat_weight.h", "weights->closed *= cosine;",
     "weights->closed = (weights->closed + weights->open) * cosine;", "light_paths_test"),
    ("inner connections weighed", "path/splat_weight.h",
     "    weights->open = INNER_CONNECTIONS && pdf_w > REAL(0.0) ? REAL(1.0) / pdf_w : REAL(0.0);", "", "light_paths_test"),
    ("squared distance on a segment from infinity", "path/splat_weight.h", "(is_point ? t * t : emission->cosine)",
     "(emission->is_delta ? t * t : emission->cosine)", "bdpt_test"),
    ("connections to a vertex behind a delta lobe weighed", "path/splat_weight.h",
     "INNER_CONNECTIONS && pdf_w > REAL(0.0) ? REAL(1.0) / pdf_w : REAL(0.0)",
     "INNER_CONNECTIONS ? REAL(1.0) / (pdf_w > REAL(0.0) ? pdf_w : REAL(1.0)) : REAL(0.0)", "bdpt_test"),
    ("squared distances forgotten in the recursion", "path/splat_weight.h", "weights->open *= t * t;", ";", "bdpt_test"),
    ("the geometry term of inner connections without the distance", "path/bdpt_connect.h", "/ (square + others)",
     "/ (REAL(1.0) + others / square)", "bdpt_test"),
    ("inner connections weighed by the other end's cosine", "path/bdpt_connect.h", "to_light * splat_cosine(light->surface.normal_g, wi)",
     "to_light * splat_cosine(eye->surface->normal_g, wi)", "bdpt_test"),
    ("inner connections weighed alone", "path/bdpt_connect.h", "/ (square + others)", "/ square", "bdpt_test"),
    ("light vertices not counted", "integrators/bdpt.h", "(real)count * light_vertices_share(kept)", "light_vertices_share(kept)",
     "bdpt_test"),
    ("kept vertices of a long light path counted once", "integrators/bdpt.h", "(real)count * light_vertices_share(kept)", "(real)count",
     "bdpt_test"),
    ("inner connections through walls", "integrators/bdpt.h", "slab_straight_share(scene, params, &connection.shadow)", "REAL(1.0)", "bdpt_test"),
    ("the depth of each end alone bounded", "integrators/bdpt.h", "params->max_depth - 1u - segment", "params->max_depth", "bdpt_test"),
    ("inner connections without their excess", "film/moments.h", "moments->shared -= light * light * (count * fmin(excess, MOMENT_RIVALLED));",
     "", "integrator_choice_test"),
    ("the power of a kept vertex without its throughput", "path/light_path.h", "path->emission.power * path->throughput, vertices",
     "path->emission.power, vertices", "bdpt_test"),
    ("light paths by the window's numbers", "integrators/light_paths.h", "return tile_pixel_number(params, x, y);", "return place;", "bdpt_test"),
    ("normals that the eye bends shared with light paths", "path/light_vertex.h", "return !(bsdf->flags & BSDF_BENT) && (is_above",
     "return (is_above", "bdpt_test"),
    ("lobes about bent normals alone", "path/light_bent.h", "return REAL(0.5) * (REAL(1.0) -", "return REAL(0.0) * (REAL(1.0) -",
     "light_paths_test"),
    ("eyes connected to another pixel's light path", "integrators/light_paths.h", "if (!INNER_CONNECTIONS || !light_paths_has_eye(params, path))",
     "if (true)", "bdpt_test"),
    ("a strategy of a chain counts as if there were one", "path/chain_path.h", "found.radiance * (real)STRATEGY_COUNT +",
     "found.radiance +", "mlt_test"),
    ("a chain's splat goes where it was before", "integrators/mlt.h", "&fresh, 1u, path.film, path.radiance,",
     "&fresh, 1u, (real2)((real)chain->x, (real)chain->y), path.radiance,", "mlt_test"),
    ("replicates of chains share their mean score", "integrators/mlt.h", "(real)arrays->scales[replicate]",
     "(real)arrays->scales[0]", "mlt_test"),
    ("chains start anywhere", "integrators/mlt.h", "const uint start = arrays->starts[item];",
     "const uint start = item % (launch->paths * launch->lengths);", "mlt_test"),
    ("a chain forgets what it has taken", "integrators/mlt.h",
     "    chain_keep(&proposal, chain->length, words);\n    chain_set_path", "    chain_set_path", "mlt_test"),
    ("steps of a chain go one way", "numerics/chain.h", "(random & 0x20000000u) ? step : 0u - step", "step", "mlt_test"),
    ("full sums wrap", "film/sum.h", "*sum = add_sat(*sum, quanta);", "*sum += quanta;", "film_tile_test"),
    ("full sums not told", "film/sum.h", "return *sum != LONG_MAX;", "return true;", "film_range_test"),
    ("full sums of splats not told", "film/sum.h", "return ((before + (ulong)quanta) >> 63) == 0ul;", "return true;",
     "film_splat_test"),
    ("full sums of splats go on", "film/sum.h", "sum_add_modulo(sum, 0ul - (ulong)quanta);", ";", "film_splat_test"),
    ("the carry between the words of a sum forgotten", "film/sum.h", "before > UINT_MAX - low ? 1u : 0u", "0u", "film_splat_test"),
    ("splats of a sample rounded alike", "film/splat.h", "sampler_word(sampler, number,", "sampler_word(sampler, 0u,",
     "film_splat_test"),
    ("a bad splat is nobody's", "integrators/pixel.h", "sample->splat_fault = fault;", ";", "splat_render_test"),
    ("splats beside the window", "film/tile.h", "- (real)params->crop_x;", "- REAL(0.0);", "film_splat_test"),
    ("splats beyond the window wrap round", "film/tile.h", "x < (real)params->crop_width", "x <= (real)params->crop_width",
     "film_splat_test"),
    ("splats without a film position", "film/splat.h", "if (real_is_nan(position.x) || real_is_nan(position.y))",
     "if (false)", "film_splat_test"),
    ("film rounds down", "film/film.h", "(sampler_unit(word) < quanta - whole ? 1 : 0)", "0", "direct_light_test"),
    ("rays below the minimum are followed", "integrators/whitted.h",
     "vector_is_below(child.weight, (real)params->min_contribution) || ", "", "ray_tree_test"),
    ("rays of a branch not counted in the weights", "integrators/distribution_light.h",
     "mis_weight(light->pdf_w, rough.pdf_w * rays)", "mis_weight(light->pdf_w, rough.pdf_w)", "distribution_test"),
    ("rays of a branch not counted in their density", "integrators/distribution_ray.h",
     "next.pdf_w * ((real)count / (real)vertex->shadow_rays)", "next.pdf_w", "distribution_test"),
    ("rays of a branch weigh as one", "integrators/distribution_ray.h", "next.weight / (real)count", "next.weight",
     "distribution_test"),
    ("shadow rays of a branch weigh as one", "integrators/distribution_light.h", "(light->pdf_w * (real)count)", "light->pdf_w",
     "distribution_test"),
    ("branches of all levels multiply", "integrators/distribution_ray.h", "child.share = path->share * count;", "",
     "distribution_test"),
    ("branches of a sample alike", "numerics/sampler.h", "* count + which);", "* count);", "sampler_test"),
    ("rays that chance spares weigh as before", "integrators/distribution_ray.h", "child.weight /= survival;", "",
     "distribution_test"),
    ("a constant sky lights rough lobes twice", "integrators/distribution_light.h", "seen.rough = 0u;", "", "distribution_test"),
    ("a map met by chance counted whole", "lights/each_light.h", "* mis_weight(pdf_w, light_pdf_w);", ";", "distribution_test"),
    ("sampled discs counted twice by a tree of rays", "lights/each_light.h",
     """emission) *
                        mis_weight(pdf_w, warp_cone_pdf_w((real)scene->lights[i].one_minus_cos));""", "emission);",
     "distribution_test"),
    ("a lamp met by chance as if a table had chosen it", "lights/each_light.h",
     "light_probability_of_emitter(scene, params, view, surface->emitter)",
     "(real)scene->emitters[surface->emitter].pdf_a", "distribution_test"),
    ("matte lobes in the density of rough ones", "integrators/distribution.h",
     "        bsdf_choose_among(bsdf, vertex.rough);", "        ;", "distribution_test"),
    ("a branch's rays share a number in the tree with its parent", "integrators/tree.h",
     "const uint number = ways * parent + which;", "const uint number = parent;", "distribution_test"),
    ("without a filter, the film shares the lobe's number", "camera/camera.h", "sampler_pair(sampler, 0u, SAMPLE_FILM)",
     "sampler_pair(sampler, 0u, HAS(EFFECT_FILTER) ? SAMPLE_FILM : SAMPLE_DIRECTION)", "effect_masks_test"),
    ("a mirror's map forgotten without glossy lobes", "scattering/material.h", "if (material->map_specular != NO_INDEX)",
     "if (HAS(EFFECT_GLOSSY) && material->map_specular != NO_INDEX)", "effect_masks_test"),
    ("tangents forgotten without normal maps", "geometry/surface.h",
     "if (!HAS(EFFECT_NORMAL_MAP | EFFECT_GLOSSY | EFFECT_ROUGH_REFRACTION | EFFECT_THIN_WALL))", "if (!HAS(EFFECT_NORMAL_MAP))",
     "effect_masks_test"),
    ("highlight without its normalisation", "integrators/direct.h", "(bsdf->exponent + REAL(2.0)) * ", "REAL(2.0) * ",
     "ray_tree_test"),
    ("chosen class not divided by its chance", "path/filter.h", "part / ((part + rest) * chance)", "part / (part + rest)",
     "paths_test"),
    ("class of an event by a coin, weighted as before", "path/filter.h", "const bool is_matte = u < chance;",
     "const bool is_matte = u < REAL(0.5);", "paths_test"),
    ("a light sampled for one class lights both", "path/filter.h",
     "return filter_part(bsdf, (accepting & LETTER_BIT(LETTER_MATTE)) ? LETTER_MATTE : LETTER_GLOSSY, wi_world);",
     "return whole;", "paths_test"),
    ("forced way through glass not weighted", "path/filter.h", "(open & LETTER_BIT(LETTER_REFRACTION)) ? 0u : BSDF_NO_REFRACTION",
     "0u", "paths_test"),
    ("forced reflection without Fresnel", "scattering/bsdf_dielectric.h", "sample->weight *= facet.forced;", "", "paths_test"),
    ("lamps are seen by every path", "path/walk.h", "automaton_accepted(path->state)", "KINDS_ALL", "paths_test"),
    ("the automaton stays where it is", "path/walk.h", "path->state = step->next[filter_letter(bsdf, next)];", "", "paths_test"),
    ("distance to the light off by one", "path/automaton.h", "segment + 1u + distance > params->max_depth",
     "segment + 2u + distance > params->max_depth", "paths_test"),
    ("paths that are too long go on", "path/automaton.h", "segment + 1u + distance > params->max_depth", "false", "paths_test"),
    ("rays that find nothing are traced", "path/automaton.h", "return (AUTOMATON_STATES[state] & STATE_CONTINUES) != 0u;",
     "return true;", "paths_test"),
    ("shadow rays of no use", "path/filter.h", "if (accepting == 0u)\n        return (real3)(REAL(0.0));", "", "paths_test"),
    ("a layer's class not weighted", "path/walk.h", "path->layers.share *= share;", ";", "paths_test"),
    ("a layer's choice weighs on the picture", "path/walk.h", "if (automaton_splits(path->state))", "if (true)", "paths_test"),
    ("all layers in one plane", "path/layers.h", "params->film_replicates + layer", "params->film_replicates", "paths_test"),
    ("reflection and refraction swapped", "path/filter.h", "? LETTER_MIRROR : LETTER_REFRACTION",
     "? LETTER_REFRACTION : LETTER_MIRROR", "paths_test"),
    ("cut paths not counted", "path/cut.h", "film_count_cut(longer.throughput, rays);", "", "cut_paths_test"),
    ("a cut path without its last BSDF", "path/cut.h", "longer.throughput *= next.weight;", "", "cut_paths_test"),
    ("ways that max_depth closes not counted", "path/automaton.h", "return open != AUTOMATON_NEXT[state];",
     "return false;", "cut_paths_test"),
    ("a replay of another sample", "integrators/replay.h", "counter.index = sample / params->replicates;",
     "counter.index = sample;", "replay_test"),
    ("choices left out of the hash", "trace/trace.h", "sampler_hash(x ^ sampler_hash(quantity + (y << 8)))", "quantity",
     "replay_test"),
    ("a lobe not recorded", "scattering/bsdf_mirror.h", "TRACE_SET(sample->lobe, LOBE_MIRROR);", "", "replay_test"),
    ("bad samples of a pixel not counted", "integrators/pixel.h",
     "++pixel_rays[tile_index(place.slot, PIXEL_RAYS_WORDS) + PIXEL_BAD_SAMPLES];", "", "replay_test"),
    ("the sampled direction not recorded", "path/walk.h", "    TRACE_VECTOR(scene, TRACE_WI, next.wi);\n", "", "replay_test"),
    ("the film's share not replayed", "integrators/replay.h",
     "    film_add(params, sums, &sample->sampler, sample->radiance);\n", "", "replay_test"),
]


# Faults that --quick draws besides. One takes 5 processor seconds in the mean and 20 at most: together a tenth of what the
# render tests may take (6 minutes on 2 cores).
DRAWN = 8


def kernels_hash():
    """A hash of all kernel files, names and text."""
    total = hashlib.sha256()
    for folder, folders, files in os.walk(KERNELS):
        folders.sort()
        for name in sorted(files):
            path = os.path.join(folder, name)
            total.update(os.path.relpath(path, KERNELS).encode())
            with open(path, "rb") as source:
                total.update(source.read())
    return total.hexdigest()


def drawn(count):
    """The names of so many faults beside those of QUICK, drawn by the kernels."""
    key = kernels_hash()
    others = [fault[0] for fault in FAULTS if fault[0] not in QUICK]
    return sorted(others, key=lambda name: hashlib.sha256((key + name).encode()).digest())[:count]


class Uncaught(Exception):
    """Why a fault counts as not caught."""


def run_tests(build, program, kernels, tests="*", until_one_fails=False, effects="all"):
    """The names of the tests that passed and of those that failed. `effects` tells whether their scenes are rendered by the
    full program or by the small one of the effects that they need."""
    command = [os.path.join(build, "tests", program), "--gtest_filter=" + tests]
    if until_one_fails:
        command.append("--gtest_fail_fast")
    run = subprocess.run(command, capture_output=True, text=True, errors="replace",
                         env=dict(os.environ, CLRT_TEST_KERNELS=kernels, CLRT_TEST_EFFECTS=effects))
    if "thrown in the test body" in run.stdout:
        raise Uncaught("%s could not run:\n%s" % (program, run.stdout[-2000:]))
    passed, failed = (set(re.findall(r"^\[ *%s *\] ([\w./]+) \(" % word, run.stdout, re.MULTILINE)) for word in ("OK", "FAILED"))
    if run.returncode and not failed:
        failed = {"(ended with %d)" % run.returncode}
    return passed, failed


def plant(kernels, file, text, fault):
    """Puts a fault into the kernels of a folder."""
    path = os.path.join(kernels, file)
    with open(path) as source:
        code = source.read()
    if text not in code:
        raise Uncaught("its text is not in %s any more" % file)
    with open(path, "w") as source:
        source.write(code.replace(text, fault))


def stale():
    """Faults whose text is no longer in the kernels: kernels change, and such a fault would no longer prove anything."""
    def is_there(file, text):
        with open(os.path.join(KERNELS, file)) as source:
            return text in source.read()
    return [name for name, file, text, _, _ in FAULTS if not is_there(file, text)]


def catch(build, fault, tests, until_one_fails):
    """The tests that catch a fault, at least one; `tests` filters them, and then passes without the fault."""
    name, file, text, replacement, program = fault
    with tempfile.TemporaryDirectory() as folder:
        kernels = os.path.join(folder, "kernels")
        shutil.copytree(KERNELS, kernels)
        # The small program with a fault serves one test, the full one many; both with the fault and without.
        effects = "all" if tests == "*" else "needed"
        if tests != "*" and run_tests(build, program, kernels, tests, effects=effects) != ({tests}, set()):
            raise Uncaught("%s does not pass without it" % tests)
        plant(kernels, file, text, replacement)
        failed = run_tests(build, program, kernels, tests, until_one_fails, effects)[1]
    if not failed:
        raise Uncaught("by " + program)
    return sorted(failed)


def main():
    build, wanted = sys.argv[1], sys.argv[2:]
    quick = wanted == ["--quick"]
    if quick:
        wanted = [fault[0] for fault in FAULTS] if "CLRT_TEST_LONG" in os.environ else list(QUICK) + drawn(DRAWN)
        print("%d of %d faults, drawn by the kernels' hash %s" % (len(wanted), len(FAULTS), kernels_hash()[:16]), flush=True)
    uncaught = 0
    for fault in FAULTS:
        name = fault[0]
        if wanted and name not in wanted:
            continue
        try:
            tests = QUICK.get(name) or CAUGHT_BY.get(name) if quick else None
            caught = catch(build, fault, tests or "*", quick)
            more = " and %d more" % (len(caught) - 1) if len(caught) > 1 else ""
            print("%-45s caught by %s%s" % (name, caught[0], more), flush=True)
        except Uncaught as reason:
            print("%-45s NOT CAUGHT: %s" % (name, reason), flush=True)
            uncaught += 1
    for name in stale():
        print("%-45s its text is not in the kernels any more" % name)
        uncaught += 1
    missing = (set(wanted) | set(CAUGHT_BY)) - {fault[0] for fault in FAULTS}
    for name in sorted(missing):
        print("%-45s no fault has this name" % name)
    return 1 if uncaught or missing else 0


if __name__ == "__main__":
    sys.exit(main())
