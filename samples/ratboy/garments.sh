# Run by samples/run.sh in this folder. The asset has the character as a collision mesh of TressFX, with joints and weights, and
# without the motion: this writes mesh and weights as a skinned character with the six joints of its spine and head, and a shake of
# the head that is ours. Arms and hands go with the chest, feet and tail with the pelvis, ears and face with the head.
awk '
  BEGIN {
    joints = split("root spine01 spine02 spine03 neck head", joint, " ")
    split("0 0.2395 0.0536 0 0.2625 0.0602 0 0.3612 0.0690 0 0.4479 0.0635 0 0.5983 0.0426 0 0.6257 0.0503", place, " ")  # m
    fps = 60; seconds = 5; pi = atan2(0, -1); vertices = triangles = all = 0
  }
  function of_bone(name) {
    if (name ~ /root|pelvis|Leg|leg|Foot|Toe|tail/) return 1
    if (name ~ /spine0/) return 1 + substr(name, index(name, "spine0") + 6, 1)
    if (name ~ /clavicle|Arm|Wrist|index|middle|thumb|pinky/) return 4
    return name ~ /neck/ ? 5 : 6
  }
  $1 ~ /^#/ || NF == 0 { next }
  $1 == "numOfBones" { reads = "bones"; next }
  $1 == "numOfVertices" { reads = "vertices"; next }
  $1 == "numOfTriangles" { reads = "triangles"; next }
  reads == "bones" { bone[$1] = of_bone($2) }
  reads == "vertices" {
    x[vertices] = $2 " " $3 " " $4
    for (k = 0; k < 4; k++) weight[vertices, bone[$(8 + k)]] += $(12 + k)
    vertices++
  }
  reads == "triangles" { triangle[triangles++] = $2 " " $3 " " $4 }

  # 0 to 1 and back: grows within `rise` seconds from `from` on, and dies down after `until` in the same time.
  function smooth(u) { return u <= 0 ? 0 : u >= 1 ? 1 : u * u * (3 - 2 * u) }
  function during(t, from, until, rise) { return smooth((t - from) / rise) * (1 - smooth((t - until) / rise)) }
  # Looks to one side, shakes its head like a wet dog, nods twice, and stands. Degrees about y, z and x.
  function yaw(t) { return 30 * during(t, 0.3, 0.9, 0.3) + 40 * during(t, 1.2, 2.3, 0.25) * sin(2 * pi * 2.6 * (t - 1.2)) }
  function roll(t) { return 14 * during(t, 1.2, 2.3, 0.25) * sin(2 * pi * 2.6 * (t - 1.2) - 0.8) }
  function pitch(t) { return 14 * during(t, 1.1, 2.4, 0.3) + 24 * during(t, 3.0, 3.9, 0.2) * sin(2 * pi * 1.7 * (t - 3.0)) }
  # Its share of the three, and by how much it is behind the head [s].
  function share(j) { return j == 6 ? 0.4 : j == 5 ? 0.24 : j > 1 ? 0.12 : 0 }
  function local_matrix(j, t,    s, late, a, b, c, k, d) {
    s = share(j) * pi / 180; late = j > 1 ? 0.03 * (6 - j) : 0
    a = s * yaw(t - late); b = s * roll(t - late); c = s * pitch(t - late)
    for (k = 1; k <= 3; k++) d[k] = place[3 * j - 3 + k] - (j > 1 ? place[3 * j - 6 + k] : 0)
    return sprintf("%.6f %.6f %.6f %.6f %.6f %.6f %.6f %.6f %.6f %.6f %.6f %.6f 0 0 0 1",
      cos(a) * cos(b) + sin(a) * sin(c) * sin(b), -cos(a) * sin(b) + sin(a) * sin(c) * cos(b), sin(a) * cos(c), d[1],
      cos(c) * sin(b), cos(c) * cos(b), -sin(c), d[2],
      -sin(a) * cos(b) + cos(a) * sin(c) * sin(b), sin(a) * sin(b) + cos(a) * sin(c) * cos(b), cos(a) * cos(c), d[3])
  }
  function array(id, kind, count, values, stride, names) {
    printf "<source id=\"%s\"><%s id=\"%s-a\" count=\"%d\">%s</%s><technique_common><accessor source=\"#%s-a\" count=\"%d\" stride=\"%d\">%s",
      id, kind, id, count, values, kind, id, count / stride, stride, names
    print "</accessor></technique_common></source>"
  }
  function param(name, type) { return "<param name=\"" name "\" type=\"" type "\"/>" }

  END {
    print "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
    print "<asset><unit meter=\"1\" name=\"meter\"/><up_axis>Y_UP</up_axis></asset>\n<library_geometries><geometry id=\"body\" name=\"body\"><mesh>"
    for (v = 0; v < vertices; v++) places = places x[v] "\n"
    array("places", "float_array", 3 * vertices, places, 3, param("X", "float") param("Y", "float") param("Z", "float"))
    print "<vertices id=\"corners\"><input semantic=\"POSITION\" source=\"#places\"/></vertices>"
    print "<triangles count=\"" triangles "\"><input semantic=\"VERTEX\" source=\"#corners\" offset=\"0\"/><p>"
    for (v = 0; v < triangles; v++) print triangle[v]
    print "</p></triangles></mesh></geometry></library_geometries>\n<library_controllers><controller id=\"skin\"><skin source=\"#body\">"
    print "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>"
    for (j = 1; j <= joints; j++) {
      names = names joint[j] " "
      inverse = inverse sprintf("1 0 0 %g 0 1 0 %g 0 0 1 %g 0 0 0 1\n", -place[3 * j - 2], -place[3 * j - 1], -place[3 * j])
    }
    array("joints", "Name_array", joints, names, 1, param("JOINT", "name"))
    array("inverse", "float_array", 16 * joints, inverse, 16, param("TRANSFORM", "float4x4"))
    for (v = 0; v < vertices; v++) {
      n = 0
      for (j = 1; j <= joints; j++)
        if (weight[v, j] > 0) { weights = weights weight[v, j] "\n"; pairs = pairs (j - 1) " " all++ " "; n++ }
      counts = counts n " "
      pairs = pairs "\n"
    }
    array("weights", "float_array", all, weights, 1, param("WEIGHT", "float"))
    print "<joints><input semantic=\"JOINT\" source=\"#joints\"/><input semantic=\"INV_BIND_MATRIX\" source=\"#inverse\"/></joints>"
    print "<vertex_weights count=\"" vertices "\"><input semantic=\"JOINT\" source=\"#joints\" offset=\"0\"/><input semantic=\"WEIGHT\" source=\"#weights\" offset=\"1\"/>"
    print "<vcount>" counts "</vcount><v>" pairs "</v></vertex_weights></skin></controller></library_controllers>\n<library_animations>"
    keys = fps * seconds + 1
    for (k = 0; k < keys; k++) { times = times sprintf("%.6f ", k / fps); linear = linear "LINEAR " }
    for (j = 1; j <= joints; j++) {
      print "<animation id=\"of-" joint[j] "\">"
      array("times-" j, "float_array", keys, times, 1, param("TIME", "float"))
      moves = ""
      for (k = 0; k < keys; k++) moves = moves local_matrix(j, k / fps) "\n"
      array("moves-" j, "float_array", 16 * keys, moves, 16, param("TRANSFORM", "float4x4"))
      array("ways-" j, "Name_array", keys, linear, 1, param("INTERPOLATION", "name"))
      printf "<sampler id=\"sampler-%d\"><input semantic=\"INPUT\" source=\"#times-%d\"/><input semantic=\"OUTPUT\" source=\"#moves-%d\"/>", j, j, j
      printf "<input semantic=\"INTERPOLATION\" source=\"#ways-%d\"/></sampler><channel source=\"#sampler-%d\" target=\"%s/matrix\"/></animation>\n", j, j, joint[j]
    }
    print "</library_animations>\n<library_visual_scenes><visual_scene id=\"scene\">"
    for (j = 1; j <= joints; j++)
      print "<node id=\"" joint[j] "\" name=\"" joint[j] "\" sid=\"" joint[j] "\" type=\"JOINT\"><matrix sid=\"matrix\">" local_matrix(j, -1) "</matrix>"
    for (j = 1; j <= joints; j++) print "</node>"
    print "<node id=\"ratboy\" name=\"ratboy\"><instance_controller url=\"#skin\"><skeleton>#root</skeleton></instance_controller></node>"
    print "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#scene\"/></scene></COLLADA>"
  }' ../../../shared/assets/hair/tressfx_ratboy/Ratboy_body.tfxmesh >ratboy.dae
