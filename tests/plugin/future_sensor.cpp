// A plug-in that says it was built for a version of the interface that is still to come.
#include <suite_sensor.h>

extern "C" const suite_sensor_plugin* suite_sensor_plugin_entry(void) {
  static const suite_sensor_plugin plugin = {sizeof(suite_sensor_plugin), SUITE_SENSOR_ABI + 41, "future_sensor", "",
                                             nullptr};
  return &plugin;
}
