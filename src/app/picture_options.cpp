// SPDX-License-Identifier: Apache-2.0
// The options of the group "Picture".
#include "app/layer_option.h"
#include "app/look_option.h"
#include "app/option_rows.h"
#include "output/file_name.h"
#include "output/image.h"
#include "render/layer_table.h"

namespace clrt {

namespace {

/// Pictures of a turn; more would differ by less than a tenth of a degree.
constexpr int MOST_FRAMES = 9999;
/// Pixels; a wider filter is a blurred picture.
constexpr double LARGEST_FILTER_RADIUS = 100;

void apply_filter(Options& o, const OptionValue& v) {
    const size_t colon = v.text.find(':');
    OptionValue name = v, radius = v;
    name.text = v.text.substr(0, colon);
    o.film.filter = parse_choice<Filter>(name);
    o.film.filter_radius.reset();
    if (colon == std::string::npos)
        return;
    radius.text = v.text.substr(colon + 1);
    o.film.filter_radius = parse_number(radius, "a radius in pixels above 0 and up to 100 after the ':'",
                                        [](double r) { return r > 0 && r <= LARGEST_FILTER_RADIUS; });
}

/// "36": a turn of 36 pictures; "36:5": the fifth of them alone.
void apply_frames(Options& o, const OptionValue& v) {
    const size_t colon = v.text.find(':');
    OptionValue all = v, one = v;
    all.text = v.text.substr(0, colon);
    o.camera.frames = static_cast<int>(parse_whole(all, 1, MOST_FRAMES));
    o.camera.frame = 0;
    if (colon == std::string::npos)
        return;
    one.text = v.text.substr(colon + 1);
    o.camera.frame = static_cast<int>(parse_whole(one, 1, *o.camera.frames));
}

void apply_output(Options& o, const OptionValue& v) {
    const std::string path = parse_result(v);
    if (!is_output_path(path))
        reject_value(v, expected_output());
    o.output.files.push_back(path);
}

} // namespace

std::vector<OptionSpec> picture_options() {
    static const std::string aov_help =
        "layers of EXR files, such as albedo,N or none: " + layer_names(" ") +
        ", NAME=EXPR for the light of some paths, such as 'caustics=LS+DE', and, of bdpt, strategies[:K] for "
        "the light of each strategy: layers strategy.sS.tT join S vertices from a light to T from the eye, "
        "for paths of up to K segments (5; at most 8), strategy.longer has the rest, and all of them add up "
        "to the picture; repeatable (default: all but "
        "alpha, denoisingAlbedo and denoisingNormal, which are means over misses too, and the mattes "
        "cryptoObject and cryptoMaterial; badSamples where there are any; what is seen first by a pixel's "
        "first "
        "16 samples, where layers that are named have all)";
    const char* const group = "Picture";
    return {
        {group, "r", "--size", "WxH", "width and height in pixels (default 800x600)",
         [](Options& o, const OptionValue& v) { o.film.size = parse_size(v); }},
        {group, "o", "--output", "FILE",
         ".png .jpg .bmp .tga .ppm (8-bit sRGB), .exr .hdr .pfm .tif (linear), or to the standard output as "
         "png:-, exr:- and so on, the report then to stderr; {seed}, {spp} and {frame} in it and in --stats "
         "become numbers, {frame:4} one of four digits, {{ and }} braces; repeatable (default SCENE.png in "
         "the current folder)",
         apply_output, REPEATABLE},
        {group, "", "--frames", "N[:K]",
         "turntable: N pictures, the eye going once around --at about --up; lights stay with the scene; "
         "names get "
         "-0001 and so on, or say where by {frame}; -s, -t and -e count for each; N:K renders the K-th of "
         "them "
         "alone (default: one picture)",
         apply_frames},
        {group, "", "--crop", "X0,Y0,X1,Y1",
         "render this window only; pixels from the top left, end excluded",
         [](Options& o, const OptionValue& v) { o.film.crop = parse_crop(v); }},
        {group, "", "--filter", "NAME[:RADIUS]",
         "box, tent or gaussian; radius in pixels (default box; radius 0.5, 1 or 1.5)", apply_filter},
        {group, "", "--exposure", "auto|EV", EXPOSURE_HELP, apply_exposure},
        {group, "", "--tonemap", "NAME", TONEMAP_HELP, apply_tonemap},
        {group, "", "--aov", "LIST", aov_help.c_str(), apply_aov, REPEATABLE},
        {group, "", "--denoise", "[=NAME]",
         "add a denoised picture to EXR files (layers denoised and error.denoised) and its error, which the "
         "halves of the --replicates tell of each other, to the report: filter (regression along what is "
         "seen first, the same bits everywhere), oidn (Open Image Denoise, loaded from --oidn) or auto (oidn "
         "where it is found, else filter) (alone: auto; default: none)",
         [](Options& o, const OptionValue& v) {
             o.denoise.denoiser = v.text.empty() ? Denoiser::AUTO : parse_choice<Denoiser>(v);
         }},
        {group, "", "--oidn", "FILE",
         "the library of Open Image Denoise 2, such as libOpenImageDenoise.so.2 of PyPI's pyoidn (default: "
         "variable CLRT_OIDN, else where libraries are)",
         [](Options& o, const OptionValue& v) { o.denoise.oidn_path = parse_path(v); }},
        {group, "", "--png-from", "raw|denoised",
         "what PNG and other 8-bit pictures show; other files hold the picture as it is rendered (default "
         "raw)",
         [](Options& o, const OptionValue& v) { o.denoise.png_from = parse_choice<PngFrom>(v); }},
        {group, "", "--exr-names", "clrt|blender",
         "names of the layers of EXR files: ours, or those of Blender's passes (Combined, Depth, Normal, "
         "Position, Albedo), which it loads; alpha is 1 where the background is seen, unless "
         "--background transparent or --aov alpha (default clrt)",
         [](Options& o, const OptionValue& v) { o.output.exr_names = parse_choice<ExrNames>(v); }},
    };
}

} // namespace clrt
