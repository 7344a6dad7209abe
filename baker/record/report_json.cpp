#include "baker/record/report_json.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "baker/systems/interface/system.h"

namespace ft::inline baker {
namespace {

constexpr std::array k_incident_kinds = {
    Incident::Kind::k_crossing,  Incident::Kind::k_penetration,  Incident::Kind::k_released,
    Incident::Kind::k_strain,    Incident::Kind::k_start_inside, Incident::Kind::k_rewind,
    Incident::Kind::k_unsettled, Incident::Kind::k_open_seam,    Incident::Kind::k_cut_short};

template <class Profile, class Visit>
void for_each_time(Profile& p, Visit&& visit) {
  for (const ProfilePhase& phase : profile_phases()) visit(phase.key, p.*phase.time);
  visit("total", p.total);
}

/// JSON has no infinity: null stands for it, both ways.
Json value_of(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}
Json value_of(const Vec3& v) {
  return Json::array({value_of(v.x()), value_of(v.y()), value_of(v.z())});
}
Json value_of(int v) {
  return v;
}
Json value_of(bool v) {
  return v;
}

struct Faulty {
  std::string_view name;  ///< of a field; outlives the fault
};

void take(const Json& from, std::string_view name, double& out) {
  if (!from.is_number()) throw Faulty{name};
  out = from.get<double>();
}
void take(const Json& from, std::string_view name, int& out) {
  if (!from.is_number_integer()) throw Faulty{name};
  out = from.get<int>();
}
void take(const Json& from, std::string_view name, bool& out) {
  if (!from.is_boolean()) throw Faulty{name};
  out = from.get<bool>();
}
void take(const Json& from, std::string_view name, std::string& out) {
  if (!from.is_string()) throw Faulty{name};
  out = from.get<std::string>();
}

template <class T>
void take_field(const Json& from, std::string_view name, T& out) {
  const auto it = from.find(name);
  if (it == from.end()) return;
  if constexpr (std::is_same_v<T, double>) {
    if (it->is_null()) {
      out = std::numeric_limits<double>::infinity();
      return;
    }
  }
  take(*it, name, out);
}

/// Three numbers; null is taken for 0.
void take_vector(const Json& from, std::string_view name, Vec3& out) {
  const auto it = from.find(name);
  if (it == from.end()) return;
  if (!it->is_array() || it->size() != 3) throw Faulty{name};
  for (int k = 0; k < 3; ++k)
    if (const Json& v = (*it)[static_cast<std::size_t>(k)]; !v.is_null()) take(v, name, out[k]);
}

Incident incident_from(const Json& json) {
  Incident out;
  if (!json.is_object()) throw Faulty{"incidents"};
  std::string kind;
  take_field(json, "kind", kind);
  for (const auto k : k_incident_kinds)
    if (kind == name(k)) out.kind = k;
  take_field(json, "frame", out.frame);
  take_field(json, "system", out.system);
  take_field(json, "vertex", out.vertex);
  take_vector(json, "place", out.place);
  take_field(json, "depth", out.depth);
  take_field(json, "text", out.text);
  return out;
}

InteractionForce force_from(const Json& json) {
  InteractionForce out;
  if (!json.is_object()) throw Faulty{"forces"};
  take_field(json, "system", out.system);
  take_vector(json, "force", out.mean.force);
  take_vector(json, "torque", out.mean.torque);
  take_field(json, "peak", out.peak);
  take_field(json, "contact", out.contact_share);
  take_field(json, "primary", out.primary);
  return out;
}

/// [first, count, first, count, ...].
AbsentRuns absent_from(const Json& json) {
  AbsentRuns out;
  if (!json.is_object()) throw Faulty{"absent"};
  take_field(json, "system", out.system);
  if (json.contains("collider")) take_field(json, "collider", out.collider);
  const auto runs = json.find("runs");
  if (runs == json.end() || !runs->is_array() || runs->size() % 2 != 0) throw Faulty{"absent"};
  for (std::size_t i = 0; i < runs->size(); i += 2) {
    std::array<int, 2> run{};
    for (std::size_t k = 0; k < 2; ++k) {
      take((*runs)[i + k], "absent", run[k]);
      if (run[k] < 0) throw Faulty{"absent"};
    }
    out.runs.push_back(run);
  }
  return out;
}

void write_value(std::string& out, const Json& json, int depth) {
  const bool flat = depth >= 2 || !json.is_structured() || json.empty();
  if (flat) {
    out += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  const std::string indent(static_cast<std::size_t>(depth) + 1, ' ');
  out += json.is_object() ? "{" : "[";
  bool first = true;
  for (const auto& item : json.items()) {
    out += first ? "\n" : ",\n";
    first = false;
    out += indent;
    if (json.is_object())
      out.append(Json(item.key()).dump(-1, ' ', false, Json::error_handler_t::replace)).append(": ");
    write_value(out, item.value(), depth + 1);
  }
  out.append("\n").append(indent, 1).append(json.is_object() ? "}" : "]");
}

}  // namespace

Json to_json(const Incident& i) {
  return Json{{"kind", name(i.kind)},       {"frame", i.frame},           {"system", i.system}, {"vertex", i.vertex},
              {"place", value_of(i.place)}, {"depth", value_of(i.depth)}, {"text", i.text}};
}

Json to_json(const InteractionForce& f) {
  Json out{{"system", f.system},
           {"force", value_of(f.mean.force)},
           {"torque", value_of(f.mean.torque)},
           {"peak", value_of(f.peak)},
           {"contact", value_of(f.contact_share)}};
  if (!f.primary.empty()) out["primary"] = f.primary;
  return out;
}

Json to_json(const AbsentRuns& absent) {
  Json runs = Json::array();
  for (const auto& [first, count] : absent.runs) runs.push_back(first), runs.push_back(count);
  Json out{{"system", absent.system}, {"runs", std::move(runs)}};
  if (!absent.collider.empty()) out["collider"] = absent.collider;
  return out;
}

Json to_json(const FrameReport& report) {
  Json out = Json::object();
  out["frame"] = report.frame;
  for (const Metric& metric : frame_metrics())
    std::visit(
        [&](auto member) {
          if constexpr (!std::is_same_v<decltype(member), std::monostate>)
            out[std::string(metric.key)] = value_of(report.*member);
        },
        metric.member);
  for (const auto& [key, value] : report.own) out[key] = value_of(value);
  if (!report.forces.empty()) {
    Json list = Json::array();
    for (const InteractionForce& f : report.forces) list.push_back(to_json(f));
    out["forces"] = std::move(list);
  }
  if (!report.absent.empty()) {
    Json list = Json::array();
    for (const AbsentRuns& a : report.absent) list.push_back(to_json(a));
    out["absent"] = std::move(list);
  }
  if (!report.incidents.empty()) {
    Json list = Json::array();
    for (const Incident& i : report.incidents) list.push_back(to_json(i));
    out["incidents"] = std::move(list);
  }
  return out;
}

Json to_json(const FrameProfile& profile) {
  Json out = Json::object();
  for_each_time(profile, [&](std::string_view name, double value) { out[name] = value_of(value); });
  return out;
}

Result<FrameReport> frame_report_from_json(const Json& json) {
  FrameReport out;
  try {
    if (!json.is_object()) return input_error("a frame's report is not an object");
    take_field(json, "frame", out.frame);
    for (const Metric& metric : frame_metrics())
      std::visit(
          [&](auto member) {
            if constexpr (!std::is_same_v<decltype(member), std::monostate>) take_field(json, metric.key, out.*member);
          },
          metric.member);
    for (const Metric& metric : declared_metrics())
      if (json.contains(metric.key)) take_field(json, metric.key, out.own[std::string(metric.key)]);
    if (const auto list = json.find("forces"); list != json.end()) {
      if (!list->is_array()) throw Faulty{"forces"};
      for (const Json& f : *list) out.forces.push_back(force_from(f));
    }
    if (const auto list = json.find("absent"); list != json.end()) {
      if (!list->is_array()) throw Faulty{"absent"};
      for (const Json& a : *list) out.absent.push_back(absent_from(a));
    }
    if (const auto list = json.find("incidents"); list != json.end()) {
      if (!list->is_array()) throw Faulty{"incidents"};
      for (const Json& i : *list) out.incidents.push_back(incident_from(i));
    }
  } catch (const Faulty& fault) {
    return input_error(std::string("a frame's report has a \"").append(fault.name).append("\" of another type"));
  }
  return out;
}

Result<FrameProfile> frame_profile_from_json(const Json& json) {
  FrameProfile out;
  try {
    if (!json.is_object()) return input_error("a frame's times are not an object");
    for_each_time(out, [&](std::string_view name, double& value) { take_field(json, name, value); });
  } catch (const Faulty& fault) {
    return input_error(std::string("a frame's times have a \"").append(fault.name).append("\" of another type"));
  }
  return out;
}

Result<Json> parse_json(const std::string& text, const std::string& where) {
  auto json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return input_error("is not valid JSON", where);
  return json;
}

std::string to_text(const Json& json) {
  std::string out;
  write_value(out, json, 0);
  return out + "\n";
}

FrameReport merge(const FrameReport& a, const FrameReport& b) {
  return merge(a, b, declared_metrics());
}

}  // namespace ft::inline baker
