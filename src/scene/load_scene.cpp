// SPDX-License-Identifier: Apache-2.0
#include "scene/load_scene.h"

#include "colour.h"
#include "error.h"
#include "output/standard_streams.h"
#include "scene/assemble_geometry.h"
#include "scene/build_extension.h"
#include "scene/camera_fit.h"
#include "scene/camera_motion.h"
#include "scene/clear_eye.h"
#include "scene/cut_vast.h"
#include "scene/daylight.h"
#include "scene/emission.h"
#include "scene/environment.h"
#include "scene/far_notices.h"
#include "scene/file_camera.h"
#include "scene/ground.h"
#include "scene/inside_out.h"
#include "scene/lights.h"
#include "scene/material_override.h"
#include "scene/measured_store.h"
#include "scene/mesh_motion.h"
#include "scene/normalise.h"
#include "scene/place_instances.h"
#include "scene/readers/reader_table.h"
#include "scene/scene_up.h"
#include "scene/smoothing.h"
#include "scene/split_emitters.h"
#include "scene/studio.h"
#include "scene/texture_store.h"
#include "scene/vertex_colours.h"
#include "scene/view_frame.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <new>
#include <optional>

namespace clrt {
namespace {

/// Seconds since it was made.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The pictures of a scene, and the time that they take.
class Pictures {
public:
    Pictures(TextureFilter filter, NoticeList& notices, double& seconds)
        : store_(filter), notices_(notices), seconds_(seconds) {}

    TextureStore& store() { return store_; }

    u32 add(const TextureUse& use, TextureRole role) {
        return timed([&] { return store_.add(use, role, notices_); });
    }

    void read_ahead(const std::vector<std::pair<TextureUse, TextureRole>>& uses) {
        timed([&] {
            store_.read_ahead(uses, notices_);
            return 0;
        });
    }

    PictureFacts facts() {
        return {
            [this](const TextureUse& use, TextureRole role) {
                return timed([&] { return store_.is_readable(use, role, notices_); });
            },
            [this](const TextureUse& use) {
                return timed([&] { return store_.is_normal_map(use, notices_); });
            },
            [this](const TextureUse& use) { return timed([&] { return store_.has_alpha(use, notices_); }); }};
    }

private:
    template <typename Question>
    auto timed(const Question& question) -> decltype(question()) {
        const Stopwatch watch;
        const auto answer = question();
        seconds_ += watch.seconds();
        return answer;
    }

    TextureStore store_;
    NoticeList& notices_;
    double& seconds_;
};

/// Reads the scene's file with the reader of its format.
SceneDescription read_scene(const SceneOptions& options, Progress& progress, Pictures& pictures,
                            LoadStatistics& statistics, NoticeList& notices) {
    const Stopwatch watch;
    progress.update({"load", 0});
    SceneFile file = read_scene_file(options.path);
    statistics.obj_bytes = file.bytes.size();
    const PictureFacts facts = pictures.facts();
    const SceneReader& reader = find_reader(file);
    if (options.gltf.time && !reader.plays_animations)
        throw SceneError(
            file.name, 0,
            fmt::format("--animation-time: expected a glTF file with animations, found {}", reader.name));
    SceneDescription description =
        reader.read(std::move(file),
                    {progress, notices, facts, options.mtl, options.gltf,
                     end_option(options) ? Toggle::OFF : options.instances, end_option(options) != nullptr});
    statistics.obj_seconds = watch.seconds() - statistics.texture_seconds;
    statistics.dropped_faces = description.dropped_faces;
    return description;
}

/// Puts one material in the place of all, where that is asked for; they have no maps, and no colours.
void replace_materials(MaterialOverride which, SceneDescription& description, NoticeList& notices) {
    const MaterialReplacement* replacement = find_replacement(which);
    if (!replacement)
        return;
    for (MaterialDescription& material : description.materials)
        material = replace_material(material, *replacement, notices);
    description.mesh.colours.clear();
    description.colour_remarks.clear();
}

/// Moves what the pictures became into the scene.
void take_pictures(TextureStore& store, Scene& scene) {
    for (const std::string& path : store.files())
        scene.files.push_back({"the texture", path});
    scene.textures = store.take_textures();
    scene.texture_names = store.take_names();
    scene.texture_places = store.take_places();
    scene.texel_words = store.take_words();
}

void note_remarks(const std::vector<Remark>& remarks, NoticeList& notices) {
    for (const Remark& remark : remarks)
        notices.add(remark.text, remark.place);
}

/// All uses of pictures by materials.
std::vector<std::pair<TextureUse, TextureRole>> uses_of(const std::vector<MaterialDescription>& descriptions,
                                                        const MaterialContext& context) {
    std::vector<std::pair<TextureUse, TextureRole>> uses;
    const LoadMap note = [&](const TextureUse& use, TextureRole role) {
        uses.emplace_back(use, role);
        return 0u;
    };
    for (const MaterialDescription& description : descriptions)
        build_extension(description, build_material(description, context, note), context, note);
    return uses;
}

/// Builds the described materials. Returns what each emits: luminance, mean over its map, times coverage,
/// doubled where both sides shine.
std::vector<double> build_materials(const std::vector<MaterialDescription>& descriptions, bool two_sided,
                                    Progress& progress, Pictures& pictures, Scene& scene,
                                    NoticeList& notices) {
    const bool nested =
        std::any_of(descriptions.begin(), descriptions.end(),
                    [](const MaterialDescription& each) { return each.priority.has_value(); });
    const MaterialContext context{scene.normalisation.scale, two_sided, nested};
    const LoadMap load_map = [&](const TextureUse& use, TextureRole role) { return pictures.add(use, role); };
    std::vector<double> exitance;
    progress.update({"textures", 0});
    pictures.read_ahead(uses_of(descriptions, context));
    MeasuredStore measured;
    for (const MaterialDescription& description : descriptions) {
        progress.update({"textures", double(exitance.size()) / double(descriptions.size())});
        note_remarks(description.surface_remarks, notices);
        const Material material = build_material(description, context, load_map);
        scene.emitted.push_back(emitted_radiance(material, pictures.store()));
        exitance.push_back(emitted_luminance(material, scene.emitted.back()));
        scene.materials.push_back(material);
        BuiltExtension built = build_extension(description, material, context, load_map);
        if (material.lobes & LOBE_MEASURED)
            built.extension.measured = measured.add(description.measured, notices);
        append_extension(built, scene);
        scene.material_names.push_back(description.name);
        scene.material_places.push_back(description.place);
        scene.material_rules.push_back(description.rule);
    }
    take_pictures(pictures.store(), scene);
    measured.take(scene);
    return exitance;
}

/// The sky that is asked for; its sun joins the others.
Daylight add_daylight(const glm::dvec3& up, LightOptions& light) {
    Daylight daylight = make_daylight(*light.sky, up);
    daylight.sun.irradiance *= light.environment_scale;
    if (largest_component(daylight.sun.irradiance) > 0)
        light.suns.push_back(daylight.sun);
    return daylight;
}

/// Emitters first, which the studio asks for; the ground last, which no fit may see.
void load_camera_and_lights(const SceneRequest& request, const SceneDescription& description,
                            const std::vector<double>& exitance, const Bounds& bounds, Scene& scene,
                            NoticeList& notices) {
    Emitters emitters = build_emitters(scene.positions, scene.triangles, exitance);
    scene.emitters = std::move(emitters.emitters);
    LightOptions light = request.light;
    light.points.insert(light.points.end(), description.points.begin(), description.points.end());
    light.suns.insert(light.suns.end(), description.suns.begin(), description.suns.end());
    const bool has_light =
        light.sky || !scene.emitters.empty() || !light.points.empty() || !light.suns.empty();
    scene.is_studio = light.studio && !has_light && !light.environment && light.environment_file.empty();
    scene.camera = fit_camera(request.camera, request.size, scene, bounds, notices);
    note_far_options(scene.camera, request.size, light.points, bounds, notices);
    const glm::dvec3 up = request.camera.up.value_or(DEFAULT_UP);
    if (scene.is_studio)
        light = studio_light(light, scene, up, notices);

    std::optional<Daylight> daylight;
    if (light.sky)
        daylight = add_daylight(up, light);
    scene.radius = bounds.radius() * scene.normalisation.scale;
    Lights lights = build_lights(light, scene.normalisation, scene.radius, notices);
    scene.lights = std::move(lights.lights);
    scene.light_sources = std::move(lights.sources);
    scene.emitted_power = emitters.power + lights.power;
    scene.environment = daylight ? map_environment(daylight->image, light.environment_scale, 0, notices)
                                 : load_environment(light, has_light, notices);
    if (light.background)
        scene.background = light.background->radiance;
    if (light.ground && light.ground->albedo)
        append_ground(glm::normalize(up), *light.ground->albedo, scene);
}

/// The camera with the scene's own up where none is given.
CameraOptions with_up(const CameraOptions& given, const FoundUp& found, const std::string& path,
                      NoticeList& notices) {
    CameraOptions camera = given;
    const bool is_fitted = !camera.eye;
    if (found.is_sure && is_fitted)
        camera.up = UP_Z;
    if (found.is_z_likely)
        notices.add_line(fmt::format(camera.up ? "{}: z is taken as up, --up z, since {}; --up y keeps y"
                                               : "{}: it looks as if z is up, since {}: --up z turns it",
                                     path, found.reason));
    return camera;
}

/// Says which lights move in an animation: they are taken as they are at its first moment.
void note_moving_lights(const SceneDescription& start, const SceneDescription& end, const std::string& path,
                        NoticeList& notices) {
    if (start.points.size() != end.points.size() || start.suns.size() != end.suns.size() ||
        start.cameras.size() != end.cameras.size())
        throw SceneError(path, 0, "expected a file that stays as it is while it is read, found it changed");
    bool moves = false;
    for (size_t i = 0; i < start.points.size(); ++i) {
        const PointOptions &a = start.points[i], &b = end.points[i];
        moves =
            moves || a.position != b.position || (a.cone && b.cone && a.cone->direction != b.cone->direction);
    }
    for (size_t i = 0; i < start.suns.size(); ++i)
        moves = moves || start.suns[i].towards != end.suns[i].towards;
    if (moves)
        notices.add(
            "--animation-time T,T2: point lights, spots and suns that move are shown where they are at T");
}

/// The file that holds the scene at time 1.
const std::string& end_file(const SceneOptions& scene) {
    return scene.end_path.empty() ? scene.path : scene.end_path;
}

/// What messages call the scene at both ends of the way.
MotionFiles motion_files(const SceneOptions& scene) {
    const std::string start = input_name(scene.path);
    if (!scene.end_time)
        return {start, scene.end_path};
    return {fmt::format("{} at {} s", start, *scene.gltf.time),
            fmt::format("{} at {} s", start, *scene.end_time)};
}

/// The scene at time 1; pictures are not looked at.
SceneDescription read_end(const SceneRequest& request, Progress& progress) {
    SceneFile file = read_scene_file(end_file(request.scene));
    const SceneReader& reader = find_reader(file);
    GltfReading gltf = request.scene.gltf;
    if (request.scene.end_time)
        gltf.time = request.scene.end_time;
    NoticeList unused; // what is wrong with materials is said of the first file
    const PictureFacts facts = {[](const TextureUse&, TextureRole) { return true; },
                                [](const TextureUse&) { return false; },
                                [](const TextureUse&) { return false; }};
    return reader.read(std::move(file),
                       {progress, unused, facts, request.scene.mtl, gltf, Toggle::OFF, true});
}

/// Moves the scene's mesh to where another file or a later moment has it at time 1. Returns the cameras of
/// that moment; of another file none.
std::vector<FileCamera> add_end_frame(const SceneRequest& request, Progress& progress,
                                      SceneDescription& start, std::vector<NamedFile>& files,
                                      NoticeList& notices) {
    SceneDescription end = read_end(request, progress);
    add_motion(motion_files(request.scene), shutter_times(request.camera), start.mesh, std::move(end.mesh),
               notices);
    if (request.scene.end_time) {
        note_moving_lights(start, end, input_name(request.scene.path), notices);
        return end.cameras;
    }
    files.push_back({"the scene at time 1", request.scene.end_path});
    files.insert(files.end(), end.files.begin(), end.files.end());
    return {};
}

Scene load_all(SceneRequest request, Progress& progress) {
    Scene scene;
    NoticeList notices;
    Pictures pictures(request.scene.texture_filter, notices, scene.statistics.texture_seconds);
    const std::string path = input_name(request.scene.path);

    SceneDescription description = read_scene(request.scene, progress, pictures, scene.statistics, notices);
    Mesh& mesh = description.mesh;
    scene.object_names = mesh.object_names;
    scene.files = description.files;

    std::vector<FileCamera> end_cameras;
    if (end_option(request.scene))
        end_cameras = add_end_frame(request, progress, description, scene.files, notices);

    // The frame, then everything that is measured in it.
    const Bounds bounds = bounds_with_instances(description, bounds_of_triangles(mesh));
    scene.picture_size = take_file_camera(description.cameras, end_cameras, bounds, request, notices);
    if (!request.camera.up && !description.is_y_up)
        request.camera =
            with_up(request.camera, find_up(mesh, bounds, description.z_up_reason), path, notices);
    scene.normalisation = fit_normalisation(bounds);
    note_coarse_digits(mesh, bounds, path, notices);
    if (request.writes_layers)
        note_relative_positions(scene.normalisation, notices);
    smooth_by_groups(mesh, path, notices);
    replace_materials(request.scene.material_override, description, notices);
    note_remarks(description.colour_remarks, notices);
    const std::vector<double> exitance =
        build_materials(description.materials, request.light.two_sided, progress, pictures, scene, notices);
    assemble_geometry(mesh, bounds, scene.normalisation, path, scene, notices);
    const CutTriangles cut = cut_vast_triangles(scene);
    if (cut.vast)
        notices.add_line(fmt::format("{}: {} triangles are vast beside what lies near them: cut into {}",
                                     path, cut.vast, cut.vast + cut.added));
    const StandIns stand_ins = add_stand_ins(description, scene);
    load_camera_and_lights(request, description, exitance, bounds, scene, notices);
    remove_stand_ins(stand_ins, scene);
    clear_eye(scene, notices);
    append_instances(description, path, scene, notices);
    note_inside_out_glass(scene, notices);
    split_emitters(scene);
    store_vertex_colours(scene, path);
    finish_moves(end_file(request.scene), scene);
    scene.notices = notices.lines();
    return scene;
}

} // namespace

Scene load_scene(const SceneRequest& request, Progress& progress) {
    try {
        return load_all(request, progress);
    } catch (const std::bad_alloc&) {
        throw SceneError(
            input_name(request.scene.path), 0,
            "not enough memory to load the scene: expected a smaller one, smaller textures, or a "
            "machine with more memory");
    }
}

} // namespace clrt
