# A fabric's sheet as SVG: curves of force over strain along warp, weft and bias, of the files STEM.0, .90 and .45, and the border of the draped
# specimen from above with its disc, of STEM.border. awk -v name=denim -v stem=fabrics/denim -v row="| ... |" -f sheet.awk
function curve(file, colour, label, place,    line, part, path) {
    while ((getline line < file) > 0) {
        split(line, part, " ")
        if (part[2] <= 110) path = path sprintf("%s%.1f,%.1f", path ? " " : "", 60 + 14 * part[1], 300 - 2.4 * part[2])
    }
    printf "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", path, colour
    printf "<text x=\"70\" y=\"%d\" fill=\"%s\">%s</text>\n", place, colour, label
}
function tick(x, y, text) { printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", x, y, text }
BEGIN {
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 370\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"720\" height=\"370\" fill=\"white\"/>"
    printf "<text x=\"20\" y=\"22\" font-size=\"16\">%s</text>\n", name
    print "<path d=\"M60 40V300H350\" fill=\"none\" stroke=\"black\"/>"
    for (f = 0; f <= 100; f += 20) tick(54, 304 - 2.4 * f, f)
    for (e = 0; e <= 20; e += 5) tick(64 + 14 * e, 316, e)
    print "<text x=\"160\" y=\"334\">strain, %</text><text x=\"20\" y=\"40\">gf/cm</text>"
    curve(stem ".0", "#1f5fa8", "warp", 60)
    curve(stem ".90", "#c0392b", "weft", 76)
    curve(stem ".45", "#27833a", "bias", 92)
    while ((getline line < (stem ".border")) > 0) {
        split(line, part, " ")
        path = path sprintf("%s%.1f,%.1f", path ? " " : "", 540 + 1000 * part[1], 170 + 1000 * part[3])
    }
    print "<circle cx=\"540\" cy=\"170\" r=\"150\" fill=\"none\" stroke=\"#bbb\"/>"
    printf "<polygon points=\"%s\" fill=\"#d8e2ee\" stroke=\"black\"/>\n", path
    print "<circle cx=\"540\" cy=\"170\" r=\"90\" fill=\"none\" stroke=\"black\" stroke-dasharray=\"4 3\"/>"
    n = split(row, cell, / *[|] */)
    printf "<text x=\"20\" y=\"356\">G %s gf/cm degree, c %s cm, drape %s %%, %s nodes</text>\n", cell[6], cell[7], cell[8], cell[9]
    print "</svg>"
}
