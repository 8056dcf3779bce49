// A scene of HELIOS++ for tests, with every filter that is read.
#pragma once
#include <string>

namespace suite::test {

inline std::string helios_scene() {
  return R"(<?xml version="1.0"?>
<document><scene id="plot" name="a plot">
<part id="tree-1"><filter type="objloader"><param type="string" key="filepath" value="data/tree.obj"/><param type="string" key="up" value="y"/></filter>
<filter type="rotate"><param type="rotation" key="rotation"><rot axis="z" angle_deg="30"/><rot axis="pitch" angle_deg="10"/></param></filter>
<filter type="scale"><param type="double" key="scale" value="2"/></filter>
<filter type="translate"><param type="vec3" key="offset" value="10;+5;-1.5"/><param type="int" key="onGround" value="0"/></filter></part>
<part id="tree-2"><filter type="objloader"><param type="string" key="filepath" value="data\tree.obj"/><param type="string" key="up" value="y"/></filter></part>
<part><filter type="detailedvoxels"><param type="string" key="filepath" value="crown.vox"/></filter>
<filter type="translate"><param type="vec3" key="offset" value="0;0;3"/></filter></part>
<part><filter type="geotiffloader"><param type="string" key="filepath" value="ground.tif"/></filter></part>
<part><filter type="xyzloader"><param type="string" key="filepath" value="points.xyz"/></filter></part>
</scene></document>
)";
}

}  // namespace suite::test
