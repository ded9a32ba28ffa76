# Doxygen's view of a header: members whose name means the same wherever it stands, because templates
# ask for it by that name, get their sentence here instead of one in every class; what is only
# defaulted or deleted has no sentence. Lines keep their numbers.
#
# know(NAME, SENTENCE): of members (functions if NAME ends in a bracket) that have no words of their own,
# in the headers that `where` names.
function know(name, sentence) { sentences[name] = sentence; headers[name] = where }
BEGIN {
  where = "render/.*(surface|field|effect)/"
  # SurfaceStage (surface_response.h), FrictionLaw (friction_stage.h), effects and fields (effect_table.h).
  know("touch(", "Changes what is felt, in every tick of contact (SurfaceStage). Real-time: safe.")
  know("leave(", "Forgets what belongs to a contact that has ended (SurfaceStage). Real-time: safe.")
  know("pull(const", "Gives the force with which the surface holds back, N in W (FrictionLaw). Real-time: safe.")
  know("turn(const Turn", "Carries what is remembered along as the normal turns (FrictionLaw). Real-time: safe.")
  know("forget(", "Ends what is remembered: the contact is over (FrictionLaw). Real-time: safe.")
  know("read(", "Reads the settings, with units and limits, as scenes name them. Real-time: never from the servo thread.")
  know("list_settings(", "Tells which settings may be turned while it runs. Real-time: never from the servo thread.")
  know("force(", "Gives the force on the hand, N in W (Field). Real-time: safe.")
  know("kGroup", "Is the key by which scenes name its group.")
  know("kName", "Is the name by which scenes choose it.")
  know("kOrder", "Is where it stands among the effects of a tick.")
  know("Settings", "Is what a scene may set of it; `read` tells units and limits.")
  know("coulomb", "Friction that does not depend on speed.")
  know("viscous", "Friction that grows with speed.")
  where = "driver/arms/"
  # WireArm (wire_arm.h).
  know("decode(", "Understands a report; false, and `reading` is left alone, if it cannot. Real-time: safe.")
  know("encode(", "Writes motor values into a message and tells its length. Real-time: safe.")
  # What is made of parts shows them.
  where = ""
  know("counters() const", "Counts what went otherwise than it should. Real-time: safe.")
  where = "render/"
  know("mesh() const", "Shows the mesh. Real-time: safe.")
  know("search() const", "Shows how the surface is searched. Real-time: safe.")
  know("contact() const", "Shows how the surface is followed. Real-time: safe.")
  know("surface() const", "Shows the surface. Real-time: safe.")
  know("tracker() const", "Shows what follows the surface. Real-time: safe.")
  know("stages() const", "Shows its stages. Real-time: safe.")
  know("law() const", "Shows its force law. Real-time: safe.")
  know("stage() const", "Shows its stage. Real-time: safe.")
  know("settings() const", "Tells what it was made with. Real-time: safe.")
  know("motion() const", "Shows the motion. Real-time: safe.")
  know("body() const", "Shows the body. Real-time: safe.")
  know("shape() const", "Shows the shape. Real-time: safe.")
  where = ""
  know("plant() const", "Shows the mechanics. Real-time: safe.")
  know("model() const", "Tells geometry, motors and encoders. Real-time: safe.")
  know("state() const", "Tells its state now. Real-time: safe.")
  know("active() const", "Tells the triangle that is touched. Real-time: safe.")
  know("triangle_count() const", "Tells the number of triangles. Real-time: safe.")
  know("vertex_count() const", "Tells the number of vertices. Real-time: safe.")
}
{
  line = $0
  if (line ~ /= (default|delete);/) { print ""; next }
  if (line ~ /^ *\/\/\/ /) { documented = 1; print line; next }
  if (line ~ /^ *(template|requires)/) { print line; next }  # its words stand above
  if (!documented && line ~ /^ *[A-Za-z]/ && line !~ /\/\/\/<|override|enum / &&
      line !~ /^ *(return|if|for|while|else|case|switch|using|friend|public|private)/) {
    for (name in sentences) {
      if (FILENAME !~ headers[name]) continue
      place = index(line, name)
      if (place < 2 || substr(line, place - 1, 1) !~ /[ *&]/) continue
      after = substr(line, place + length(name), 1)
      before = substr(line, 1, place - 1)
      if (name !~ /[( ]/ && after ~ /[A-Za-z_:]/) continue
      if (before ~ /[(=<.]/ || name == "Settings" && before !~ /struct $/) continue
      if (name ~ /\(/ && before !~ /[A-Za-z>&*] *[&*]?$/) continue
      indent = match(line, /[^ ]/) - 1
      line = sprintf("%*s/** %s */ %s", indent, "", sentences[name], substr(line, indent + 1))
      break
    }
  }
  if (!documented && line !~ /\/\*\*/ && line ~ /^ *(explicit )?[A-Z][A-Za-z]*\(/) {  # a constructor
    sub(/[^ ].*/, "/** Takes what it is made of. */ &", line)
  }
  # One comment behind several members of a line is of each of them.
  if (line ~ /^ *[^(]*[A-Za-z>] [a-z_0-9]+( = [^,;]*)?, [^(]*;  *\/\/\/< / && line !~ /\/\*\*/) {
    place = index(line, "///< ")
    words = substr(line, place + 5)
    members = substr(line, 1, place - 1)
    sub(/; *$/, "", members)
    kind = members
    inner = members
    gsub(/<[^>]*>/, "", inner)
    split(inner, part, ", ")
    kind = substr(members, 1, index(members, ">") > 0 ? index(members, ">") : match(members, /[A-Za-z:0-9] /))
    sub(/^ *[^ ]+ /, "", inner)
    count = split(inner, part, ", ")
    line = ""
    for (i = 1; i <= count; ++i) line = line kind " " part[i] "; /**< " words " */ "
  }
  documented = 0
  print line
}
