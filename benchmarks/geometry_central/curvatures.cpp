// Reads a mesh with geometry-central's reader and prints, for each vertex that it has: its Gauss curvature and its mean
// curvature, both integrated, and its dual area.
#include <cstdio>
#include <exception>
#include <memory>
#include <tuple>

#include "geometrycentral/surface/meshio.h"
#include "geometrycentral/surface/vertex_position_geometry.h"

int main(int count, char** arguments) {
  using namespace geometrycentral::surface;
  if (count != 2) return 2;
  try {
    std::unique_ptr<SurfaceMesh> mesh;
    std::unique_ptr<VertexPositionGeometry> geometry;
    std::tie(mesh, geometry) = readSurfaceMesh(arguments[1]);
    geometry->requireVertexGaussianCurvatures();
    geometry->requireVertexMeanCurvatures();
    geometry->requireVertexDualAreas();
    for (Vertex v : mesh->vertices())
      std::printf("%.17g %.17g %.17g\n", geometry->vertexGaussianCurvatures[v], geometry->vertexMeanCurvatures[v],
                  geometry->vertexDualAreas[v]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
