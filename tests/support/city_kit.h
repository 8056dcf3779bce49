// A small city for tests, in CityJSON.
#pragma once
#include <string>

namespace suite::test {

// A house of 10 x 6 x 4 m with a window in its southern wall (a hole), in a solid with semantics; a plain block
// without; a template that stands twice; a point. UTM 32N.
inline std::string small_city(const std::string& version = "1.1") {
  return R"({"type":"CityJSON","version":")" + version +
         R"(","transform":{"scale":[0.001,0.001,0.001],"translate":[500000,5600000,100]},
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/25832"},
"CityObjects":{
"house":{"type":"Building","geometry":[
 {"type":"MultiSurface","lod":"0","boundaries":[[[0,3,2,1]]]},
 {"type":"Solid","lod":"2.2","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4],[8,9,10,11]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]],
  "semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}],"values":[[0,1,2,2,2,null]]}}]},
"block":{"type":"GenericCityObject","geometry":[{"type":"MultiSurface","lod":"1","boundaries":[[[0,1,2]],[[0,2,3]]]}]},
"trees":{"type":"CityObjectGroup","geometry":[
 {"type":"GeometryInstance","template":0,"transformationMatrix":[2,0,0,1,0,2,0,0,0,0,2,0,0,0,0,1],"boundaries":[4]},
 {"type":"GeometryInstance","template":0,"transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"boundaries":[6]}]},
"part":{"type":"BuildingPart","parents":["none"],"geometry":[{"type":"MultiPoint","lod":"1","boundaries":[0]}]}},
"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2.1","boundaries":[[[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},
"vertices":[[0,0,0],[10000,0,0],[10000,6000,0],[0,6000,0],[0,0,4000],[10000,0,4000],[10000,6000,4000],[0,6000,4000],
[2000,0,1000],[2000,0,3000],[4000,0,3000],[4000,0,1000]]})";
}

// One building of CityGML 2.0 whose solid refers to its thematic surfaces, with a hole and a turned face, and two
// trees of one prototype.
inline std::string small_gml() {
  return R"(<?xml version="1.0"?>
<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gml="http://www.opengis.net/gml" xmlns:xlink="http://www.w3.org/1999/xlink">
<gml:boundedBy><gml:Envelope srsName="urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783" srsDimension="3"/></gml:boundedBy>
<cityObjectMember><bldg:Building gml:id="b1">
 <bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing>
  <gml:posList>0 0 0 1 0 0 0 1 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember></gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid>
 <bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember xlink:href="#p1"/></gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>
 <bldg:boundedBy><bldg:RoofSurface><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:Polygon gml:id="p1">
  <gml:exterior><gml:LinearRing><gml:posList>0 0 3 10 0 3 10 10 3 0 10 3 0 0 3</gml:posList></gml:LinearRing></gml:exterior>
  <gml:interior><gml:LinearRing><gml:pos>4 4 3</gml:pos><gml:pos>4 6 3</gml:pos><gml:pos>6 6 3</gml:pos><gml:pos>4 4 3</gml:pos></gml:LinearRing></gml:interior>
 </gml:Polygon></gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:RoofSurface></bldg:boundedBy>
 <bldg:boundedBy><bldg:WallSurface><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:OrientableSurface orientation="-"><gml:baseSurface>
  <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 0 3 10 0 3 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
 </gml:baseSurface></gml:OrientableSurface></gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:WallSurface></bldg:boundedBy>
</bldg:Building></cityObjectMember>
<cityObjectMember><veg:SolitaryVegetationObject xmlns:veg="http://www.opengis.net/citygml/vegetation/2.0" gml:id="t1"><veg:lod2ImplicitRepresentation><ImplicitGeometry>
 <transformationMatrix>2 0 0 0 0 2 0 0 0 0 2 1 0 0 0 1</transformationMatrix>
 <relativeGMLGeometry><gml:MultiSurface gml:id="proto"><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 0 1 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember></gml:MultiSurface></relativeGMLGeometry>
 <referencePoint><gml:Point><gml:pos>100 200 3</gml:pos></gml:Point></referencePoint></ImplicitGeometry></veg:lod2ImplicitRepresentation></veg:SolitaryVegetationObject></cityObjectMember>
<cityObjectMember><veg:SolitaryVegetationObject xmlns:veg="http://www.opengis.net/citygml/vegetation/2.0" gml:id="t2"><veg:lod2ImplicitRepresentation><ImplicitGeometry>
 <relativeGMLGeometry xlink:href="#proto"/><referencePoint><gml:Point><gml:pos>1 1 1</gml:pos></gml:Point></referencePoint></ImplicitGeometry></veg:lod2ImplicitRepresentation></veg:SolitaryVegetationObject></cityObjectMember>
</CityModel>
)";
}

}  // namespace suite::test
