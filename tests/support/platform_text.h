// A sound platform, which tests of bad input break in one place.
#pragma once
#include <string>

namespace suite::test {

inline const std::string kGoodPlatform =
    "kind: platform\n"
    "name: uas\n"
    "motion: {kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 10}\n"
    "jitter: {rotate_x: {sigma_rad: 1.0e-5}}\n"
    "tasks: [{name: pass, start: 0, stop: 1}]\n"
    "truth: [material]\n"
    "attachments:\n"
    "  - name: gimbal\n"
    "    mount: {kind: whisk, axis: across, amplitude_deg: 5, rate_hz: 1}\n"
    "    instruments:\n"
    "      - name: eye\n"
    "        focal_length_mm: 50\n"
    "        f_number: 4\n"
    "        distortion: {k1: -0.01}\n"
    "        psf: {kind: gaussian, sigma_um: 3}\n"
    "        clock: {rate_hz: 2}\n"
    "        arrays:\n"
    "          - name: main\n"
    "            columns: 10\n"
    "            rows: 8\n"
    "            pitch_um: 5\n"
    "            integration_time_s: 0.01\n"
    "            readout: {kind: rolling, row_time_s: 0.001}\n"
    "            paths: 4\n"
    "            bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1}]\n"
    "            detector: {quantum_efficiency: 0.5, gain_e_per_dn: 2}\n";

}  // namespace suite::test
