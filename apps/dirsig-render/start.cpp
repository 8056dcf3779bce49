#include "start.h"

#include "base/files.h"
#include "base/run_app.h"
#include "sensor/run_facts.h"

namespace suite {

void start_sensors(const Simulation& simulation, const JobOptions& options, const std::string& folder) {
  RunFacts facts{options.pipeline.seed, folder, strf("suite %s: ", kVersion) + command_line(), {}};
  if (!folder.empty())
    facts.write = [folder](const std::string& subfolder, const std::string& file, std::string_view bytes) {
      const std::string path = folder + "/" + subfolder;
      make_folder(path);
      write_file(path + "/" + file, bytes);
      note("wrote " + path + "/" + file);
    };
  for (const auto& sensor : simulation.sensors) sensor->start(facts);
}

}  // namespace suite
