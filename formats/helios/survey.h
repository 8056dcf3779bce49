// Surveys of HELIOS++ (survey, platform and scanner XML) as simulation texts of ours. See FORMAT.md.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/helios/helios.h"

namespace suite {

// What is taken otherwise than there, or left out; every element and attribute that is not used is one.
struct HeliosFinding {
  Where where;
  std::string text;
};

struct HeliosSurvey {
  HeliosText text;
  std::vector<HeliosFinding> findings;
};

struct HeliosSurveyFiles {
  // A file that a location names, by its place and what it holds.
  struct Named {
    std::string path, text;
  };
  std::function<Named(const std::string& name)> read;
  std::function<std::string(const std::string& scene)> prepared;  // the .h5 of a scene's file
};

// The first survey of a document. Error, located: no XML, no survey, no such scanner or platform, numbers that are
// none, a platform that follows a trajectory; as `files`.
HeliosSurvey parse_helios_survey(std::string_view text, const std::string& file, const HeliosSurveyFiles& files);

// By the beginning of a file.
bool is_helios_survey(const std::string& path, std::string_view head);

}  // namespace suite
