# perf report --sort dso,symbol -> one line per part of the event simulation: scene part percent
/^#/ || NF < 3 { next }
{
  percent = $1 + 0
  name = $2 " " substr($0, index($0, "]") + 2)
}
name ~ /embree|RayCaster|Visibility::visible/ { part["trace"] += percent; next }
name ~ /Occluder|is_alone|pyramid|triangle_pass|PassingTriangle|TriangleSight|stays_|misses|find_passing|asters|PatchLight|find_light|find_shadows|light_of|::inside|nearest_of|visible_exactly|Scene::meets/ { part["foresee"] += percent; next }
name ~ /CellWalk|CellCourse|Borders|TrackPart|Texture::range|Texture::cell|radiance_range|picture_range|range_across|RadianceRange|Thresholds|certif|PlaneSignal::range/ { part["walk"] += percent; next }
name ~ /EventLog|BlockJournal|H5|hdf5|libz|deflate|Sha|sha256|Crc|DatasetWriter|EventFile/ { part["write"] += percent; next }
name ~ /find_exit|first_exit|refine|PixelSignal|PlaneSignal|PixelSensor|interpolate|is_straight|dividing|change_s|is_crease|EventPixel|libm/ { part["roots"] += percent; next }
name ~ /sort|partition|SensedEvent|deliver/ { part["sort"] += percent; next }
name ~ /Scene|RayTracer|Texture|PlaneView|PlanePath|sample|illuminat|Illumination|Background|SurfaceLook/ { part["look"] += percent; next }
name ~ /Tile|EventCamera|FrameCamera|Function_handler|SplineTable|ObjectMotion|image_speed|interaction|Spline|tbb|parallel/ { part["schedule"] += percent; next }
{ part["other"] += percent }
END {
  for (p in part) total += part[p]
  n = split("foresee trace look walk roots schedule sort write other", order, " ")
  for (i = 1; i <= n; ++i) printf "%s %s %.1f\n", scene, order[i], 100 * part[order[i]] / total
}
