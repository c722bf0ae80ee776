# perf report --sort dso,symbol -> one line per part of the event simulation: scene part percent
/^#/ || NF < 3 { next }
{
  percent = $1 + 0
  name = $2 " " substr($0, index($0, "]") + 2)
}
name ~ /embree|EmbreeScene|Visibility::visible/ { part["trace"] += percent; next }
name ~ /TriangleBvh|Occluder|is_sole_visible|frust|edge_functions|TransitTriangle|TriangleRayBounds|EdgeCulling|stays_|misses|find_transits|occluders|PatchLighting|find_lighting|find_shadows|lighting_of|min_barycentric|nearest_among|visible_exactly|Scene::intersects/ { part["predict"] += percent; next }
name ~ /TexelTraversal|CellSegment|TexelBorders|CoordinateBounds|Texture::range|Texture::cell|radiance_range|texture_range|range_across|RadianceRange|Thresholds|certif|TextureSignal::range/ { part["texels"] += percent; next }
name ~ /EventLog|BlockJournal|H5|hdf5|libz|deflate|Sha|sha256|Crc|DatasetWriter|EventFile/ { part["write"] += percent; next }
name ~ /find_exit|first_exit|refine|PixelSignal|TextureSignal|PixelSensor|interpolate|is_straight|split_fraction|change_s|is_crease|EventPixel|libm/ { part["crossings"] += percent; next }
name ~ /sort|partition|SensedEvent|deliver/ { part["sort"] += percent; next }
name ~ /Scene|RayTracer|Texture|PlaneSampler|TexelTrajectory|sample|illuminat|Illumination|Background|SurfaceSample/ { part["sample"] += percent; next }
name ~ /Tile|EventCamera|FrameCamera|Function_handler|SplineTable|ObjectMotion|image_speed|interaction|Spline|tbb|parallel/ { part["schedule"] += percent; next }
{ part["other"] += percent }
END {
  for (p in part) total += part[p]
  n = split("predict trace sample texels crossings schedule sort write other", order, " ")
  for (i = 1; i <= n; ++i) printf "%s %s %.1f\n", scene, order[i], 100 * part[order[i]] / total
}
