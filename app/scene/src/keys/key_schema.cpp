#include "keys/key_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

namespace thimble::scene {
namespace {

/// How keys of one map depend on each other.
enum class Relation {
  kOne,        ///< Exactly one of them is present.
  kAtMostOne,  ///< They exclude each other.
  kSecondToo,  ///< The second is present if the first is.
};

struct KeyRelation {
  /// As in KeyNote; a place that ends with `*` is a prefix, and " otherwise" is for maps without
  /// any variant.
  std::string_view place;
  Relation relation;
  std::vector<std::string_view> keys;  ///< Empty: all keys of the map.
};

/// Relations between the keys of scene and arm files. The readers check them; the key log does not
/// contain them.
const std::vector<KeyRelation>& relations() {
  static const std::vector<KeyRelation> kRelations = {
      {"", Relation::kOne, {"arm", "arms"}},
      {"", Relation::kOne, {"hand", "arms"}},
      {"", Relation::kSecondToo, {"faults", "arms"}},
      {"objects[]",
       Relation::kOne,
       {"mesh", "plane", "sphere", "box", "cylinder", "capsule", "cone", "torus", "field"}},
      {"objects[]", Relation::kAtMostOne, {"size", "scale"}},
      {"objects[].effects[]", Relation::kOne, {}},
      {"objects[]", Relation::kSecondToo, {"size", "mesh"}},
      {"objects[]", Relation::kSecondToo, {"scale", "mesh"}},
      {"objects[]", Relation::kSecondToo, {"repair", "mesh"}},
      {"objects[]", Relation::kSecondToo, {"open", "mesh"}},
      {"objects[]", Relation::kSecondToo, {"budget", "mesh"}},
      {"objects[]", Relation::kSecondToo, {"contact", "mesh"}},
      {"objects[] otherwise", Relation::kOne, {"stiffness", "stiffness_map"}},
      {"objects[]", Relation::kSecondToo, {"stiffness_map", "mesh"}},
      {"objects[]", Relation::kSecondToo, {"friction_map", "mesh"}},
      {"objects[].stiffness_map", Relation::kOne, {"image", "vertex_colour"}},
      {"objects[].friction_map", Relation::kOne, {"image", "vertex_colour"}},
      {"objects[].body.motion", Relation::kSecondToo, {"floor_friction", "floor"}},
      {"objects[].body.motion", Relation::kSecondToo, {"hold_damping", "hold"}},
      {"objects[].body.motion", Relation::kSecondToo, {"hold_force", "hold"}},
      {"effects[] friction: *", Relation::kAtMostOne, {"stiffness", "z_max"}},
      {"effects[] texture: sines.waves[]", Relation::kOne, {"wavelength", "frequency"}},
      {"hand", Relation::kOne, {"path", "bag"}},
      {"hand", Relation::kSecondToo, {"topic", "bag"}},
      {"hand", Relation::kSecondToo, {"axes", "bag"}},
      {"arms[].hand", Relation::kOne, {"path", "bag"}},
      {"arms[].hand", Relation::kSecondToo, {"topic", "bag"}},
      {"arms[].hand", Relation::kSecondToo, {"axes", "bag"}},
      {"hand.path[]", Relation::kOne, {"at", "on"}},
      {"hand.path[]", Relation::kSecondToo, {"on", "near"}},
      {"hand.path[]", Relation::kSecondToo, {"near", "on"}},
      {"hand.path[]", Relation::kSecondToo, {"press", "on"}},
      {"arms[].hand.path[]", Relation::kOne, {"at", "on"}},
      {"arms[].hand.path[]", Relation::kSecondToo, {"on", "near"}},
      {"arms[].hand.path[]", Relation::kSecondToo, {"near", "on"}},
      {"arms[].hand.path[]", Relation::kSecondToo, {"press", "on"}},
      {"joints[]", Relation::kSecondToo, {"min", "max"}},
      {"joints[]", Relation::kSecondToo, {"max", "min"}},
      {"joints[]", Relation::kSecondToo, {"speed", "motor_max"}},
      {"joints[]", Relation::kSecondToo, {"motor_max", "speed"}},
      {"joints", Relation::kSecondToo, {"continuous_current", "thermal_time_constant"}},
      {"joints", Relation::kSecondToo, {"thermal_time_constant", "continuous_current"}},
  };
  return kRelations;
}

std::string json_quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// Joins with ", ".
class Joined {
 public:
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string enum_of(const std::vector<std::string>& words) {
  Joined list;
  for (const std::string& word : words) list.add(json_quoted(word));
  return "\"enum\": [" + list.text() + ']';
}

std::string three_of(const std::string& items, const KeyValues& values) {
  return fmt::format(R"("type": "array", "minItems": {}, "maxItems": 3, "items": {{{}}})",
                     values.per_motor ? 1 : 3, items);
}

std::string range_of(std::string_view type, const KeyValues& values) {
  return fmt::format(R"("type": "{}", "minimum": {}, "maximum": {})", type, values.min, values.max);
}

/// Returns the default as JSON; empty if there is none.
std::string default_of(const KeyNote& note) {
  if (note.fallback.empty()) return {};
  switch (note.values.type) {
    case ValueType::kNumber:
    case ValueType::kWhole:
    case ValueType::kThreeNumbers:
    case ValueType::kThreeWhole:
    case ValueType::kBool:
      return note.fallback;
    case ValueType::kText:
    case ValueType::kChoice:
      return json_quoted(note.fallback);
    case ValueType::kRotation:
      return "[]";
    default:
      return {};
  }
}

/// Writes the schema of a file, map by map.
class SchemaWriter {
 public:
  explicit SchemaWriter(const std::vector<KeyNote>& keys) : keys_(keys) {}

  /// Returns the members of the schema of a map, one per line, with this indentation.
  std::string map_of(const std::string& place, int indent) const {
    std::vector<std::string> members = {R"("type": "object")"};
    std::vector<std::string> parts = relations_of(place);
    const std::vector<Variant> variants = variants_of(place);
    // A key that a variant redefines has a schema in each variant, and one for maps without any.
    Keys common, redefined;
    for (const KeyNote* note : own_keys(place)) {
      (is_redefined(*note, variants) ? redefined : common).push_back(note);
    }
    members.push_back(properties_of(common, place, indent));
    if (variants.empty()) {
      close(members, common);
    } else {
      add_variants(place, variants, indent, parts);
      add_rest(place, variants, common, redefined, indent, parts);
    }
    if (!parts.empty()) {
      members.push_back("\"allOf\": [\n" + lines(parts, indent + 2) + space(indent) + ']');
    }
    return lines(members, indent);
  }

 private:
  using Keys = std::vector<const KeyNote*>;

  /// Value of a key that decides which other keys its map has: `friction: bristle`. An empty value
  /// is any text: `law: "..."`.
  struct Variant {
    std::string key, value;
    std::string place;  ///< Place of its keys: "effects[] friction: bristle".
  };

  static std::string space(int indent) {
    return std::string(static_cast<std::size_t>(indent), ' ');
  }

  static std::string lines(const std::vector<std::string>& members, int indent) {
    std::string text;
    for (const std::string& member : members) {
      text += space(indent) + member + (&member == &members.back() ? "\n" : ",\n");
    }
    return text;
  }

  Keys own_keys(const std::string& place) const {
    Keys own;
    for (const KeyNote& note : keys_) {
      if (note.place == place) own.push_back(&note);
    }
    return own;
  }

  /// Returns the keys of the map at `place` that are also allowed in one of its variants.
  Keys shared_keys(const std::string& place, const std::string& variant) const {
    Keys shared;
    for (const KeyNote* note : own_keys(place)) {
      if (std::find(note->also_in.begin(), note->also_in.end(), variant) != note->also_in.end()) {
        shared.push_back(note);
      }
    }
    return shared;
  }

  /// Forbids keys other than these, and requires those that every such map has.
  static void close(std::vector<std::string>& members, const Keys& keys) {
    Joined required;
    for (const KeyNote* note : keys) {
      if (note->need == KeyNeed::kRequired) required.add(json_quoted(note->key));
    }
    if (!required.text().empty()) members.push_back("\"required\": [" + required.text() + ']');
    members.push_back(R"("additionalProperties": false)");
  }

  std::vector<Variant> variants_of(const std::string& place) const {
    const std::size_t dot = place.rfind('.');
    const std::string last = dot == std::string::npos ? place : place.substr(dot + 1);
    std::vector<Variant> variants;
    for (const KeyNote* note : own_keys(place)) {
      if (note->values.type == ValueType::kText) add_text_variant(last, *note, variants);
      if (note->values.type != ValueType::kChoice) continue;
      for (const std::string& value : note->values.choices) {
        std::string of = last + ' ' + note->key + ": " + value;
        if (!own_keys(of).empty() || !shared_keys(place, of).empty()) {
          variants.push_back({note->key, value, std::move(of)});
        }
      }
    }
    return variants;
  }

  /// Adds the variant of a key whose value is any text, if a place has its keys: "effects[] law:
  /// formula".
  void add_text_variant(const std::string& last, const KeyNote& text,
                        std::vector<Variant>& variants) const {
    const std::string begin = last + ' ' + text.key + ": ";
    for (const KeyNote& note : keys_) {
      if (!note.place.starts_with(begin) || note.place.find('.') != std::string::npos) continue;
      variants.push_back({text.key, "", note.place});
      return;
    }
  }

  bool is_redefined(const KeyNote& note, const std::vector<Variant>& variants) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const KeyNote& other) {
      return other.key == note.key &&
             std::any_of(variants.begin(), variants.end(),
                         [&](const Variant& variant) { return variant.place == other.place; });
    });
  }

  /// Adds a condition for each variant.
  void add_variants(const std::string& place, const std::vector<Variant>& variants, int indent,
                    std::vector<std::string>& parts) const {
    for (const Variant& variant : variants) {
      const Keys shared = shared_keys(place, variant.place);
      Keys all = own_keys(variant.place);
      std::vector<std::string> then = {properties_of(all, variant.place, indent + 6, shared)};
      const std::vector<std::string> related = relations_of(variant.place);
      if (!related.empty()) {
        then.push_back("\"allOf\": [\n" + lines(related, indent + 8) + space(indent + 6) + ']');
      }
      all.insert(all.end(), shared.begin(), shared.end());
      close(then, all);
      const std::string test =
          variant.value.empty()
              ? fmt::format(
                    R"("properties": {{{0}: {{"type": "string", "title": {1}}}}}, "required": [{0}])",
                    json_quoted(variant.key),
                    json_quoted(variant.place.substr(variant.place.rfind(": ") + 2)))
              : fmt::format(R"("properties": {{{0}: {{"const": {1}}}}}, "required": [{0}])",
                            json_quoted(variant.key), json_quoted(variant.value));
      parts.push_back(condition(test, then, indent));
    }
  }

  /// Adds the condition for maps without any variant.
  void add_rest(const std::string& place, const std::vector<Variant>& variants, const Keys& common,
                const Keys& redefined, int indent, std::vector<std::string>& parts) const {
    Joined deciding;
    std::string last;
    for (const Variant& variant : variants) {
      if (variant.key != last) {
        deciding.add(fmt::format(R"({{"required": [{}]}})", json_quoted(variant.key)));
      }
      last = variant.key;
    }
    std::vector<std::string> then = {properties_of(redefined, place, indent + 6, common)};
    close(then, own_keys(place));
    const std::vector<std::string> related = relations_of(place, " otherwise");
    if (!related.empty()) {
      then.push_back("\"allOf\": [\n" + lines(related, indent + 8) + space(indent + 6) + ']');
    }
    parts.push_back(condition("\"not\": {\"anyOf\": [" + deciding.text() + "]}", then, indent));
  }

  static std::string condition(const std::string& test, const std::vector<std::string>& then,
                               int indent) {
    return "{\n" + space(indent + 4) + "\"if\": {" + test + "},\n" + space(indent + 4) +
           "\"then\": {\n" + lines(then, indent + 6) + space(indent + 4) + "}\n" +
           space(indent + 2) + '}';
  }

  /// Returns the member `properties`: a schema for each of `keys`; `known`: keys whose schema is
  /// elsewhere.
  std::string properties_of(const Keys& keys, const std::string& place, int indent,
                            const Keys& known = {}) const {
    std::vector<std::string> members;
    for (const KeyNote* note : keys) {
      members.push_back(json_quoted(note->key) + ": {" + value_of(*note, place, indent + 2) + '}');
    }
    for (const KeyNote* note : known) members.push_back(json_quoted(note->key) + ": true");
    return "\"properties\": {\n" + lines(members, indent + 2) + space(indent) + '}';
  }

  /// Returns the members of the schema of a key.
  std::string value_of(const KeyNote& note, const std::string& place, int indent) const {
    std::string what = note.what;
    if (!what.empty())
      what[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(what[0])));
    std::string text = "\"description\": " +
                       json_quoted(note.meaning + ' ' + what + "; " + need_in_words(note) + '.');
    const std::string fallback = default_of(note);
    if (!fallback.empty()) text += ", \"default\": " + fallback;
    return text + ", " + type_of(note, (place.empty() ? "" : place + '.') + note.key, indent);
  }

  std::string type_of(const KeyNote& note, const std::string& below, int indent) const {
    const auto nested = [&](const std::string& place) {
      return '\n' + map_of(place, indent + 2) + space(indent);
    };
    switch (note.values.type) {
      case ValueType::kText:  // YAML text without quotes may look like a number
        return R"("type": ["string", "number", "boolean"], "minLength": 1)";
      case ValueType::kBool:
        return R"("type": "boolean")";
      case ValueType::kNumber:
        return range_of("number", note.values);
      case ValueType::kWhole:
        return range_of("integer", note.values);
      case ValueType::kThreeNumbers:
        return three_of(range_of("number", note.values), note.values);
      case ValueType::kThreeWhole:
        return three_of(range_of("integer", note.values), note.values);
      case ValueType::kSigns:
        return three_of(R"("enum": [1, -1])", note.values);
      case ValueType::kRotation:
        return R"("type": "array", "items": {"type": "array", "minItems": 2, "maxItems": 2, )"
               R"("prefixItems": [{"enum": ["x", "y", "z"]}, )"
               R"({"type": "number", "minimum": -360, "maximum": 360}]})";
      case ValueType::kChoice:
        return enum_of(note.values.choices);
      case ValueType::kChoices:
        return fmt::format(R"("anyOf": [{{{0}}}, {{"type": "array", "minItems": 1, )"
                           R"("items": {{{0}}}}}])",
                           enum_of(note.values.choices));
      case ValueType::kMap:
        return nested(below);
      case ValueType::kMaps:
        return R"("type": "array", "minItems": 1, "items": {)" + nested(below + "[]") + '}';
    }
    return {};
  }

  /// Returns a schema for each relation between keys of a map. `suffix` follows the place of the
  /// relations.
  std::vector<std::string> relations_of(const std::string& place,
                                        std::string_view suffix = {}) const {
    std::vector<std::string> schemas;
    for (const KeyRelation& one : relations()) {
      const bool prefix = suffix.empty() && one.place.ends_with('*');
      const std::string_view known = one.place.substr(0, one.place.size() - (prefix ? 1 : 0));
      if (prefix ? !place.starts_with(known) : place + std::string(suffix) != known) continue;
      std::vector<std::string_view> keys;
      for (const KeyNote* note : own_keys(place)) {
        const auto named = std::find(one.keys.begin(), one.keys.end(), note->key);
        if (one.keys.empty() || named != one.keys.end()) keys.emplace_back(note->key);
      }
      // Scene and arm files both have a root, and not every friction has every key.
      if (keys.size() < std::max<std::size_t>(one.keys.size(), 1)) continue;
      schemas.push_back(schema_of(one.relation, one.keys.empty() ? keys : one.keys));
    }
    return schemas;
  }

  static std::string schema_of(Relation relation, const std::vector<std::string_view>& keys) {
    Joined each, all;
    for (const std::string_view key : keys) {
      each.add(fmt::format(R"({{"required": [{}]}})", json_quoted(key)));
      all.add(json_quoted(key));
    }
    switch (relation) {
      case Relation::kOne:
        return R"({"oneOf": [)" + each.text() + "]}";
      case Relation::kAtMostOne:
        return R"({"not": {"required": [)" + all.text() + "]}}";
      case Relation::kSecondToo:
        return fmt::format(R"({{"dependentRequired": {{{}: [{}]}}}})", json_quoted(keys[0]),
                           json_quoted(keys[1]));
    }
    return {};
  }

  const std::vector<KeyNote>& keys_;
};

}  // namespace

std::string key_schema(const std::vector<KeyNote>& keys, std::string_view title) {
  std::string text = "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n";
  text += "  \"title\": " + json_quoted(title) + ",\n";
  return text + SchemaWriter(keys).map_of("", 2) + "}\n";
}

}  // namespace thimble::scene
