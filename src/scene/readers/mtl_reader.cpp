// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/mtl_reader.h"

#include "error.h"
#include "scene/conductors.h"
#include "scene/readers/mtl_texture.h"
#include "scene/readers/text_encoding.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace clrt {
namespace {

constexpr double UNLIMITED = std::numeric_limits<double>::infinity();

struct ColourKey {
    const char* name; // lower case
    std::optional<glm::dvec3> MtlMaterial::*member;
    double high;
};
constexpr ColourKey COLOUR_KEYS[] = {
    {"kd", &MtlMaterial::kd, 1},
    {"ks", &MtlMaterial::ks, 1},
    {"ke", &MtlMaterial::ke, UNLIMITED},
    {"tf", &MtlMaterial::tf, 1},
    {"attenuation", &MtlMaterial::attenuation, 1},
    {"eta", &MtlMaterial::eta, UNLIMITED},
    {"k", &MtlMaterial::k, UNLIMITED},
};

struct NumberKey {
    const char* name;
    std::optional<double> MtlMaterial::*member;
    double high;
};
constexpr NumberKey NUMBER_KEYS[] = {
    {"ns", &MtlMaterial::ns, UNLIMITED},
    {"ni", &MtlMaterial::ni, UNLIMITED},
    {"d", &MtlMaterial::d, 1},
    {"tr", &MtlMaterial::tr, 1},
    {"pr", &MtlMaterial::pr, 1},
    {"pm", &MtlMaterial::pm, 1},
    {"ps", &MtlMaterial::ps, 1},
    {"pc", &MtlMaterial::pc, UNLIMITED},
    {"pcr", &MtlMaterial::pcr, 1},
    {"aniso", &MtlMaterial::aniso, 1},
    {"anisor", &MtlMaterial::anisor, UNLIMITED},
    {"attenuation_distance", &MtlMaterial::attenuation_distance, UNLIMITED},
    {"thin_walled", &MtlMaterial::thin_walled, 1},
    {"abbe", &MtlMaterial::abbe, UNLIMITED},
    {"priority", &MtlMaterial::priority, UNLIMITED},
};

struct MapKey {
    const char* name;
    std::optional<MtlTexture> MtlMaterial::*member;
};
constexpr MapKey MAP_KEYS[] = {
    {"map_kd", &MtlMaterial::map_kd},     {"map_ks", &MtlMaterial::map_ks},
    {"map_ke", &MtlMaterial::map_ke},     {"map_d", &MtlMaterial::map_d},
    {"map_pr", &MtlMaterial::map_pr},     {"map_pm", &MtlMaterial::map_pm},
    {"map_bump", &MtlMaterial::map_bump}, {"norm", &MtlMaterial::map_normal},
    {"map_ps", &MtlMaterial::map_ps},     {"map_ns", &MtlMaterial::map_ns},
    {"map_refl", &MtlMaterial::map_refl},
};

/// Keys with two names.
constexpr std::pair<const char*, const char*> ALIASES[] = {
    {"kt", "tf"}, {"bump", "map_bump"}, {"refl", "map_refl"}};

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : char(c); });
    return result;
}

/// A key's own name, in lower case.
std::string own_name(std::string_view key) {
    const std::string name = lower(key);
    for (const auto& [alias, own] : ALIASES)
        if (name == alias)
            return own;
    return name;
}

/// One statement: its key as written, the text after it, and where it stands.
struct Statement {
    std::string_view key, value;
    SourcePlace place;
};

double read_number(const Statement& statement, std::string_view word) {
    double value = 0;
    if (!parse_number(word, value) || !std::isfinite(value))
        throw SceneError(statement.place.file, statement.place.line,
                         fmt::format("{}: expected a finite number, found {}", statement.key,
                                     word.empty() ? "the end of the line" : clrt::quoted(word)));
    return value;
}

double clamped(const Statement& statement, double value, double high, NoticeList& notices) {
    const double inside = std::clamp(value, 0.0, high);
    if (inside != value)
        notices.add(fmt::format("{} outside [0,{}] is clamped", statement.key, high), statement.place);
    return inside;
}

/// "r g b", or one number for a grey. Spectral and CIE XYZ colours need data that no kernel here has.
std::optional<glm::dvec3> read_colour(const Statement& statement, double high, NoticeList& notices) {
    std::string_view rest = without_comment(statement.value);
    std::string_view word = next_word(rest);
    const std::string kind = lower(word);
    if (kind == "spectral" || kind == "xyz") {
        notices.add(fmt::format("{} {} is not supported and ignored", statement.key, kind), statement.place);
        return std::nullopt;
    }
    glm::dvec3 colour(read_number(statement, word));
    word = next_word(rest);
    if (!word.empty()) {
        colour.y = read_number(statement, word);
        colour.z = read_number(statement, next_word(rest));
    }
    for (int c = 0; c < 3; ++c)
        colour[c] = clamped(statement, colour[c], high, notices);
    return colour;
}

/// Ka describes the ambient light of local models, which real indirect light replaces; almost every file has
/// it, so that nothing is said about what cannot be read.
std::optional<glm::dvec3> read_ambient(const Statement& statement) {
    std::string_view rest = without_comment(statement.value);
    glm::dvec3 colour(0);
    for (int c = 0; c < 3; ++c)
        if (!parse_number(next_word(rest), colour[c]) || !std::isfinite(colour[c]))
            return std::nullopt;
    return glm::clamp(colour, 0.0, 1.0);
}

std::optional<double> read_scalar(const Statement& statement, double high, NoticeList& notices) {
    std::string_view rest = without_comment(statement.value);
    std::string_view word = next_word(rest);
    const std::string key = lower(statement.key);
    if (key == "d" && lower(word) == "-halo") {
        notices.add("d -halo is read as d: the coverage does not depend on the angle", statement.place);
        word = next_word(rest);
    }
    const double value = read_number(statement, word);
    if (key == "ni" && value <= 0) {
        notices.add("Ni that is not above 0 is no index of refraction: 1.5 is taken", statement.place);
        return std::nullopt;
    }
    return clamped(statement, value, high, notices);
}

std::optional<int> read_illum(const Statement& statement, NoticeList& notices) {
    std::string_view rest = without_comment(statement.value);
    const double value = read_number(statement, next_word(rest));
    if (value < 0 || value > 9 || value != std::floor(value)) {
        notices.add(fmt::format("illum {} is no known model, the default is taken", value), statement.place);
        return std::nullopt;
    }
    return int(value);
}

/// The metal's index; an unknown name is none.
void read_conductor(const Statement& statement, MtlMaterial& material, NoticeList& notices) {
    const std::string name = lower(trim(without_comment(statement.value)));
    if (const auto index = find_conductor(name)) {
        material.eta = index->eta;
        material.k = index->k;
    } else {
        notices.add(fmt::format("{} {} is no known metal and ignored: expected one of {}", statement.key,
                                clrt::quoted(name), fmt::join(conductor_names(), ", ")),
                    statement.place);
    }
}

MeasuredUse read_measured(const Statement& statement) {
    const std::string_view file = trim(without_comment(statement.value));
    if (file.empty())
        throw SceneError(statement.place.file, statement.place.line,
                         "merl: expected the name of a file, found the end of the line");
    return {std::string(file), statement.place};
}

/// Reads a statement into the table's member; false if the key is none of the table's.
bool read_from_tables(const Statement& statement, const std::string& key, MtlMaterial& material,
                      NoticeList& notices) {
    for (const ColourKey& entry : COLOUR_KEYS)
        if (key == entry.name) {
            if (const auto colour = read_colour(statement, entry.high, notices))
                material.*entry.member = colour;
            return true;
        }
    for (const NumberKey& entry : NUMBER_KEYS)
        if (key == entry.name) {
            material.*entry.member = read_scalar(statement, entry.high, notices);
            return true;
        }
    for (const MapKey& entry : MAP_KEYS)
        if (key == entry.name) {
            if (const auto texture =
                    parse_mtl_texture(statement.key, statement.value, statement.place, notices))
                material.*entry.member = texture;
            return true;
        }
    return false;
}

void read_statement(const Statement& statement, MtlMaterial& material, NoticeList& notices) {
    const std::string key = own_name(statement.key);
    material.key_lines[key] = statement.place.line;
    if (read_from_tables(statement, key, material, notices))
        return;
    if (key == "conductor")
        read_conductor(statement, material, notices);
    else if (key == "merl")
        material.merl = read_measured(statement);
    else if (key == "ka")
        material.ka = read_ambient(statement);
    else if (key == "illum")
        material.illum = read_illum(statement, notices);
    else
        notices.add(fmt::format("{} has no effect here and is ignored", statement.key), statement.place);
}

} // namespace

std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& path, NoticeList& notices) {
    std::vector<MtlMaterial> materials;
    const MtlWriter writer = find_mtl_writer(text);
    LineReader reader(without_byte_order_mark(text));
    while (reader.next()) {
        std::string_view rest = reader.text();
        const std::string_view key = next_word(rest);
        const Statement statement{key, trim(rest), {path, reader.number()}};
        if (lower(key) == "newmtl") {
            materials.emplace_back();
            materials.back().name = std::string(statement.value);
            materials.back().place = statement.place;
            materials.back().writer = writer;
        } else if (materials.empty()) {
            notices.add("a statement before the first newmtl is ignored", statement.place);
        } else {
            read_statement(statement, materials.back(), notices);
        }
    }
    return materials;
}

std::vector<MtlMaterial> read_mtl(const std::string& path, NoticeList& notices) {
    return parse_mtl(as_utf8(read_file(path)), path, notices);
}

} // namespace clrt
