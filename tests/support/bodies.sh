# Sourced by tests whose scenes have a box as a body.
#     box_obj X0 Y0 Z0 X1 Y1 Z1        its OBJ file, from the low corner to the high one, on standard output

box_obj() {
    for box_z in "$3" "$6"; do
        for box_y in "$2" "$5"; do printf 'v %s %s %s\n' "$1" "$box_y" "$box_z" "$4" "$box_y" "$box_z"; done
    done
    printf 'f %s %s %s %s\n' 1 3 4 2 5 6 8 7 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6
}
