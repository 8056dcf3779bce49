// Some seventy broken platforms, as their users would write them: each is refused before anything is rendered, with one
// message that has its place and says what would be right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "base/files.h"
#include "support/platform_text.h"
#include "support/run_command.h"

namespace suite::platform_input_test {
namespace {

using testing::HasSubstr;

// The sound platform as the one sensor of a simulation.
std::string good_simulation() {
  std::string text = "scene: scene.h5\nepoch: 2026-06-21T10:30:00Z\nsky: {radiance: 1}\nsensors:\n", lead = "  - ";
  std::istringstream lines(test::kGoodPlatform);
  for (std::string line; std::getline(lines, line); lead = "    ") text += lead + line + "\n";
  return text;
}

struct Broken {
  const char *what, *by;     // a piece of the good text, and what stands in its place
  const char *where, *says;  // of the message, which may go on
};
constexpr Broken kBroken[] = {
    {"focal_length_mm", "focal_length_m", "yaml:16:13",
     "unknown key 'focal_length_m'; did you mean 'focal_length_mm', which is missing?"},
    {"focal_length_mm: 50", "focal_length_mm: 50 mm", "yaml:16:30", "expected a finite number, found '50 mm'"},
    {"focal_length_mm: 50", "focal_length_mm: 0", "yaml:16:30",
     "0 is outside the valid range; give a value from 0.001 to 1e+06 mm"},
    {"focal_length_mm: 50", "focal_length_mm: .nan", "yaml:16:30", "expected a finite number, found '.nan'"},
    {"focal_length_mm: 50", "focal_length_mm: .inf", "yaml:16:30", "expected a finite number, found '.inf'"},
    {"pitch_um: 5", "pitch_um: -5", "yaml:25:27",
     "the pitch of a detector is 0.001 to 1e6 um, one number or two (right, up)"},
    {"pitch_um: 5", "pitch_um: [5, 0]", "yaml:25:27",
     "the pitch of a detector is 0.001 to 1e6 um, one number or two (right, up)"},
    {"columns: 10", "columns: 100000000000", "yaml:23:26",
     "100000000000 is outside the valid range; give a whole number from 1 to 10000000"},
    {"rows: 8", "rows: 99999999", "yaml:24:23",
     "99999999 is outside the valid range; give a whole number from 1 to 100000"},
    {"columns: 10", "columns: 9999999", "yaml:22:17",
     "the lens distortion folds over at (-24999.997, -0.020) mm of the focal plane; use smaller "},
    {"position_m: [0, 0, 100]", "ecef_x_m: 4000000, ecef_y_m: 500000, ecef_z_m: 4900000", "yaml:7:13",
     "this position needs a scene with an origin on the Earth; use east_m, north_m, up_m, or giv"},
    {"position_m: [0, 0, 100]", "positon_m: [0, 0, 100]", "yaml:7:13",
     "a position is missing; is 'positon_m' meant to be 'position_m'?"},
    {"position_m: [0, 0, 100]", "position_ft: [0, 0, 100]", "yaml:7:13",
     "a position is missing; is 'position_ft' meant to be 'position_m'?"},
    {"position_m: [0, 0, 100]", "position_m: [0, 0, .nan]", "yaml:7:49", "expected a finite number, found '.nan'"},
    {"position_m: [0, 0, 100]", "position_m: [0, 0]", "yaml:7:42", "position_m needs a list of 3 numbers"},
    {"position_m: [0, 0, 100]", "latitude_deg: 49, longitude_deg: 8, height_m: 3000", "yaml:7:13",
     "this position needs a scene with an origin on the Earth; use east_m, north_m, up_m, or giv"},
    {"position_m: [0, 0, 100]", "utm_zone: 33X9, easting_m: 1, northing_m: 2, height_m: 3", "yaml:7:13",
     "this position needs a scene with an origin on the Earth; use east_m, north_m, up_m, or giv"},
    {"kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 10", "kind: keyframes, file: none.csv",
     "yaml:7:37", "there is no file 'none.csv'; relative names start at this file's folder"},
    {"kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 10",
     "kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 100]}, {time_s: 0, position_m: [0, 1, 100]}]", "yaml:7:76",
     "the times do not ascend; each key later than the one before"},
    {"kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 10",
     "kind: orbit, tle: none.tle, satellite: 1, dut1_s: 0", "yaml:7:13",
     "an orbit needs a scene with an origin on the Earth"},
    {"speed_m_s: 10", "speed_m_s: -10", "yaml:7:82",
     "-10 is outside the valid range; give a value from 0 to 1e+06 m/s"},
    {"speed_m_s: 10", "speed_m_s: 10, pointing: nadr", "yaml:7:96",
     "'nadr' is none of the choices here; did you mean 'nadir'?"},
    {"speed_m_s: 10", "speed_m_s: 0, pointing: velocity", "yaml:9:13",
     "no pose at 0 s: a track is to point along its velocity but is at rest at 0 s"},
    {"sigma_rad: 1.0e-5", "sigma_rad: -1", "yaml:8:36",
     "-1 is outside the valid range; give a value from 0 to 1e+06 rad"},
    {"sigma_rad: 1.0e-5", "sigma_m: 1", "yaml:8:24",
     "an axis of jitter is either white or has a power spectral density; give sigma_rad or psd"},
    {"rotate_x: {sigma_rad: 1.0e-5}", "rotate_x: {psd: {frequency_hz: [10, 1], density_rad2_hz: [1, 1]}}", "yaml:8:30",
     "frequency 1 Hz of a power spectral density is out of order; 0 or more, ascending"},
    {"start: 0, stop: 1", "start: 1, stop: 0", "yaml:9:42", "the task stops before it starts"},
    {"start: 0, stop: 1", "start: yesterday", "yaml:9:33", "expected a finite number, found 'yesterday'"},
    {"tasks: [{name: pass, start: 0, stop: 1}]", "tasks: []", "yaml:9:12",
     "a platform has at least one task; tasks: [{start: 0, stop: 1}]"},
    {"tasks: [{name: pass, start: 0, stop: 1}]", "tasks: [{name: a, start: 0}, {name: a, start: 1}]", "yaml:9:34",
     "two tasks are named 'a'; give each its own name"},
    {"truth: [material]", "truth: [materal]", "yaml:10:13", "unknown truth 'materal'; did you mean 'material'?"},
    {"truth: [material]", "truth: [geodetic]", "yaml:10:13",
     "the truth 'geodetic' needs a scene with an origin on the Earth; give the scene an origin"},
    {"kind: whisk", "kind: whisky", "yaml:13:23", "'whisky' is none of the choices here; did you mean 'whisk'?"},
    {"rate_hz: 1}", "rate_hz: 0}", "yaml:13:71", "0 is outside the valid range; give a value from 1e-09 to 1e+09 Hz"},
    {"amplitude_deg: 5", "amplitude_deg: 500", "yaml:13:59",
     "500 is outside the valid range; give a value from 0 to 180 degrees"},
    {"amplitude_deg: 5", "amplitude_rad: 0.1", "yaml:13:44",
     "unknown key 'amplitude_rad'; did you mean 'amplitude_deg', which is missing?"},
    {"f_number: 4", "f_number: 0", "yaml:17:23",
     "0 is outside the valid range; give a value from 0.1 to 1e+06 (focal length over diameter)"},
    {"f_number: 4", "f_number: 4\n            obscuration: 1.5", "yaml:18:26",
     "1.5 is outside the valid range; give a value from 0 to 0.95 (share of the diameter)"},
    {"f_number: 4", "throughput: 3", "yaml:17:25",
     "3 is outside the valid range; give a value from 1e-09 to 1 (share of the light)"},
    {"k1: -0.01", "k1: -1000000", "yaml:22:17",
     "the lens distortion folds over at (-0.025, -0.020) mm of the focal plane; use smaller coef"},
    {"sigma_um: 3", "sigma_um: 0", "yaml:19:45", "0 is outside the valid range; give a value from 1e-06 to 1e+06 um"},
    {"psf: {kind: gaussian, sigma_um: 3}", "psf: {kind: image, file: none.png, pixel_um: 1}", "yaml:19:18",
     "no such file; check the name; a name in a text is relative to the folder of that text"},
    {"psf: {kind: gaussian, sigma_um: 3}", "psf: {kind: mtf, cycles_per_mm: [0, 10], value: [1, 1.5]}", "yaml:19:18",
     "an MTF has ascending frequencies and values from 0 to 1"},
    {"clock: {rate_hz: 2}", "clock: {rate_hz: 2, offset_s: 5}", "yaml:9:12",
     "the instrument 'eye' takes nothing in any of the tasks; its clock's offset or its triggers"},
    {"clock: {rate_hz: 2}", "trigger: {times_s: [4, 5]}", "yaml:9:12",
     "the instrument 'eye' takes nothing in any of the tasks; its clock's offset or its triggers"},
    {"clock: {rate_hz: 2}", "trigger: {times_s: []}", "yaml:20:32", "no times: nothing would ever be taken"},
    {"clock: {rate_hz: 2}", "clock: {rate_hz: 2}\n            trigger: {distance_m: 3}", "yaml:21:22",
     "an instrument follows a clock or triggers"},
    {"clock: {rate_hz: 2}", "clock: {rate_hz: 1000000000}", "yaml:9:13",
     "1000000001 frames in one task; lower rate_hz or shorten the task"},
    {"integration_time_s: 0.01", "integration_time_s: -0.01", "yaml:26:37",
     "-0.01 is outside the valid range; give a value from 0 to 86400 s"},
    {"row_time_s: 0.001", "row_time_ms: 1", "yaml:27:42",
     "unknown key 'row_time_ms'; did you mean 'row_time_s', which is missing?"},
    {"readout: {kind: rolling, row_time_s: 0.001}", "readout: {kind: line, line_rate_hz: 750}", "yaml:26:37",
     "the integration takes longer than the 0.00133333 s from one sample to the next"},
    {"readout: {kind: rolling, row_time_s: 0.001}", "readout: {kind: global}\n                tdi: {stages: 4}",
     "yaml:28:22", "time delay and integration needs a line read-out; readout: {kind: line, line_rate_hz: N}"},
    {"paths: 4", "paths: 0", "yaml:28:24", "0 is outside the valid range; give a whole number from 1 to 1073741824"},
    {"paths: 4", "paths: {min: 64, max: 4}", "yaml:28:24", "max is less than min"},
    {"fwhm_um: 0.1", "fwhm_um: 0", "yaml:29:62", "0 is outside the valid range; give a value from 1e-06 to 1.1988 um"},
    {"fwhm_um: 0.1", "fwhm_nm: 100", "yaml:29:53", "unknown key 'fwhm_nm'; did you mean 'fwhm_um', which is missing?"},
    {"center_um: 0.6, fwhm_um: 0.1", "response: {wavelength_um: [0.5, 0.6], value: [0, 0]}", "yaml:29:47",
     "band 'pan': the response is zero everywhere; give at least two wavelengths and one positiv"},
    {"center_um: 0.6, fwhm_um: 0.1", "response: none.txt", "yaml:29:47",
     "there is no file 'none.txt'; relative names start at this file's folder"},
    {"{name: pan, center_um: 0.6, fwhm_um: 0.1}",
     "{name: pan, center_um: 0.6, fwhm_um: 0.1}, {name: pan, center_um: 0.7, fwhm_um: 0.1}", "yaml:29:68",
     "two bands are named 'pan'; give each its own name"},
    {"quantum_efficiency: 0.5", "quantum_efficiency: 1.5", "yaml:30:48",
     "the quantum efficiency leaves 0..1; electrons per photon"},
    {"quantum_efficiency: 0.5", "quantum_efficiency: {wavelength_um: [0.4, 0.5], value: [0.5, 0.5]}", "yaml:30:27",
     "a curve from 0.4 to 0.5 um was asked at 0.500326 um; the quantum efficiency must cover eve"},
    {"gain_e_per_dn: 2", "gain_e_per_dn: 0", "yaml:30:68",
     "0 is outside the valid range; give a value from 1e-09 to 1e+12 electrons per count"},
    {"gain_e_per_dn: 2", "gain_e_per_dn: 2, bits: 99", "yaml:30:77",
     "99 is outside the valid range; give a whole number from 1 to 16"},
    {"gain_e_per_dn: 2", "gain_e_per_dn: 2, bad_pixels: [[100, 2]]", "yaml:30:84",
     "there is no detector [100, 2]; columns 0 to 9, rows 0 to 7"},
    {"columns: 10", "chips: []", "yaml:23:24", "an array has at least one chip"},
    {"columns: 10", "chips: [{columns: 4, offset_mm: [0, 0]}, {columns: 4, offset_mm: [0, 0]}]", "yaml:23:58",
     "chip 2 overlaps chip 1 in the focal plane; give it another offset_mm, or an array of its o"},
    {"kind: platform", "kind: plattform", "yaml:5:11",
     "unknown sensor kind 'plattform' [SE101]; did you mean 'platform'?"},
    {"name: main", "nmae: main", "yaml:22:17", "unknown key 'nmae'; did you mean 'name'?"},
    {"attachments:", "attachements:", "yaml:11:5", "unknown key 'attachements'; did you mean 'attachments'?"},
    {"epoch: 2026-06-21T10:30:00Z", "epoch: 2026-06-31T10:30:00Z", "yaml:2:8", "2026-06 has no day 31"},
    {"columns: 10\n                rows: 8\n                pitch_um: 5",
     "columns: 100000\n                rows: 40000\n                pitch_um: 0.001", "yaml:5:5",
     "the largest capture of sensor 'uas' takes 1.63e+03 GB, and this machine has "},
};

class PlatformInput : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    write_file(*folder_ / "scene.yaml",
               std::string_view("scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.5}}\nobjects: {p: {plane: "
                                "{width: 0, depth: 0}, material: grey}}\nworld: [{place: p}]\n"));
    prep_ = run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static CommandResult render(const std::string& text, const std::string& name) {
    write_file(*folder_ / (name + ".yaml"), std::string_view(text));
    return run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/dirsig-render " + name + ".yaml -o " + name +
                       " -q");
  }
  static TempFolder* folder_;
  static CommandResult prep_;
};
TempFolder* PlatformInput::folder_ = nullptr;
CommandResult PlatformInput::prep_;

TEST_F(PlatformInput, TheGoodOneRenders) {
  ASSERT_EQ(prep_.code, 0) << prep_.err;
  const CommandResult r = render(good_simulation(), "good");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(file_exists(*folder_ / "good/uas_0000.img"));
}

TEST_F(PlatformInput, EveryBrokenOneIsRefusedInItsPlace) {
  int n = 0;
  for (const Broken& b : kBroken) {
    std::string text = good_simulation();
    const size_t at = text.find(b.what);
    ASSERT_NE(at, std::string::npos) << b.what;
    text.replace(at, std::string_view(b.what).size(), b.by);
    const CommandResult r = render(text, "bad");
    EXPECT_EQ(r.code, 1) << b.by;
    EXPECT_THAT(r.err, testing::StartsWith(std::string("bad.") + b.where + ": error: " + b.says)) << b.by;
    EXPECT_EQ(r.err.find("error:"), r.err.rfind("error:")) << "one message: " << r.err;
    EXPECT_FALSE(file_exists(*folder_ / "bad/render.json")) << b.by;
    ++n;
  }
  std::printf("%d broken platforms refused\n", n);
}

}  // namespace
}  // namespace suite::platform_input_test
