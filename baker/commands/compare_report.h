// Reports of compare as text for people, JSON for scripts, JUnit XML for build servers and one self-contained HTML page
// with plots and a picture of where the difference is.
#pragma once

#include <string>
#include <vector>

#include "baker/commands/compare.h"
#include "baker/commands/compare_forces.h"
#include "baker/commands/compare_primaries.h"

namespace ft::inline baker {

std::string compare_text(const std::vector<CompareReport>& reports);
std::string compare_json(const std::vector<CompareReport>& reports, const std::vector<ForceComparison>& forces = {},
                         const std::vector<PathComparison>& paths = {});
std::string compare_junit(const std::vector<CompareReport>& reports);
std::string compare_html(const std::vector<CompareReport>& reports);

/// "equal", "different", "incomparable".
std::string_view verdict_name(CompareVerdict verdict);
/// What there is to say about one pair, in one sentence.
std::string summary(const CompareReport& report);
/// A length as people read it: "0", "1.2e-07 mm", "0.25 mm", "3.1 m".
std::string length_text(double metres);
/// Text for the inside of XML and HTML elements and attributes.
std::string escaped(std::string_view text);

}  // namespace ft::inline baker
