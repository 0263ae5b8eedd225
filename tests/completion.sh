#!/bin/sh
# Completion of the installed programs: bash offers every option that --help has and nothing else, names of policies, keys and shipped
# scenes; zsh does alike. The scenes themselves are found by name.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -z "${SANITIZER:-}" || skip_all "what is installed is the same in a build with sanitizers"
usr=$scratch/usr
programs="duite-compare duite-garment duite-graph duite-mannequin duite-predict duite-trace duite-view"
unset MAKEFLAGS MFLAGS MAKELEVEL

plan_later
ok "duite installs" install_duite "$usr"
PATH=$usr/bin:$PATH
export PATH
mkdir "$scratch/work"
cd "$scratch/work" || exit 99

cat > ask.bash << 'END'
# PROGRAM WORD...: what is offered for the last word, a line each
. "$1/share/bash-completion/completions/$2"
shift
complete -p "$1" > /dev/null || exit
function=$(complete -p "$1" | sed 's/.*-F \([^ ]*\) .*/\1/')
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
$function "$1" "${@: -1}" "${@: -2:1}"
printf '%s\n' "${COMPREPLY[@]}"
END
asks() { bash ask.bash "$usr" "$@" | sort > offered; }
offers() { # WORDS PROGRAM WORD...
    echo "$1" | tr ' ' '\n' | sort > wanted
    shift
    asks "$@" && diff wanted offered
}
contains() { # WORDS PROGRAM WORD...
    echo "$1" | tr ' ' '\n' | sort > wanted
    shift
    asks "$@" && cat offered && test -z "$(comm -23 wanted offered)"
}
every_option() { # PROGRAM
    asks "$1" -- && sed 's/=$//' offered | sort > options && "$1" --help | sed -n 's/^ \{0,6\}\(-., \)\{0,1\}\(--[a-z0-9-]*\).*/\2/p' | sort > helped &&
        test "$(wc -l < helped)" -gt 5 && diff helped options
}
policies() { # KIND OPTION: the names that an error lists, but those for tests
    duite-cloth x.yaml "--$1" none-such 2> said
    sed 's/.*known are //; s/, for tests.*//; s/, and shared.*//; s/,//g' said | tr ' ' '\n' | sort > wanted
    asks duite-cloth "--$1" = '' && cat offered && test "$(wc -l < wanted)" -ge 3 && diff wanted offered
}
linked() { for program in $programs; do test -s "$usr/share/bash-completion/completions/$program" || return 1; done; }

ok "each program has its file" linked
for program in duite-cloth $programs; do
    if test -x "$usr/bin/$program"; then ok "every option of $program" every_option $program; else skip "options of $program" "not built"; fi
done
ok "an option that takes a value ends with =" offers "--scenes --scheduler=" duite-cloth --sc
ok "schedulers" policies scheduler
ok "mappings" policies mapping
ok "balancers" policies balance
ok "policies of duite-predict" offers "fifo" duite-predict x --scheduler = f
ok "keys of scenes" contains "time.h= time.end=" duite-cloth --set time.
ok "keys of lists" offers "cloths[0].mesh.grid.nx= cloths[0].mesh.grid.ny=" duite-cloth --set 'cloths[0].mesh.grid.n'
ok "garments" offers "skirt tshirt trousers" duite-garment --own ''
ok "measures" offers "waist= wrist=" duite-mannequin --measure w
ok "shipped scenes" contains "sheet.yaml shirt.yaml zara.yaml" duite-cloth ''
touch mine.yaml mine.txt && mkdir mine
ok "scenes and folders here" offers "mine mine.yaml" duite-cloth mi
ok "folders for --output" offers "mine" duite-cloth --output mi

in_zsh() { # WORD LINE: zsh offers the word for the line
    cat > drive.zsh << 'END'
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z "PS1=; fpath=($3 \$fpath); autoload -U compinit; compinit -u -D; LISTMAX=9999; bindkey '^I' list-choices; print rea''dy"
while zpty -r z line; do [[ $line != *ready* ]] || break; done
zpty -w -n z "$2"$'\t'
all=
while zpty -r z line "*$1*"; do all+=$line; [[ $all != *$1* ]] || { print found; exit 0; } done
END
    limited zsh -f drive.zsh "$1" "$2" "$usr/share/zsh/site-functions" < /dev/null
}
if command -v zsh > /dev/null; then
    DUITE_TIMEOUT=60
    ok "zsh offers options" in_zsh --trace-steps 'duite-cloth --trac'
    ok "zsh offers policies" in_zsh priority 'duite-cloth --scheduler='
    ok "zsh offers keys" in_zsh time.energy_growth 'duite-cloth --set time.'
    ok "zsh offers shipped scenes" in_zsh zara.yaml 'duite-cloth '
    unset DUITE_TIMEOUT
else
    skip "zsh" "not installed"
fi

# ---- The scenes themselves

listed() { # all, with a sentence each
    duite-cloth --scenes > scenes && cat scenes && (cd "$srcdir/cloth/scenes" && ls ./*.yaml gallery/*.yaml) | sed 's|^\./||' | LC_ALL=C sort > wanted && sed 's/ .*//' scenes | LC_ALL=C sort | diff wanted - &&
        ! grep -v '^[a-z/]*\.yaml  *[A-Z].*\.$\|\.\.\.$' scenes
}
ok "--scenes lists what was installed" listed
ok "a shipped scene is found by name" limited duite-cloth zara.yaml --quiet --set cloths[0].mesh.grid.nx=9 --set cloths[0].mesh.grid.ny=9
ok "by two ranks, too" ranks 2 duite-cloth zara.yaml --quiet --set cloths[0].mesh.grid.nx=9 --set cloths[0].mesh.grid.ny=9 --grain 20
echo 'schema: 2' > zara.yaml
ok "a file here comes first" sh -c '! duite-cloth zara.yaml 2> said && grep schema said'
ok "a path is a path" sh -c '! duite-cloth ./sheet.yaml 2> said && grep "cannot open the scene file" said'
moved() { mv "$usr" "$scratch/elsewhere" && LD_LIBRARY_PATH=$scratch/elsewhere/lib "$scratch/elsewhere/bin/duite-cloth" --scenes | grep '^zara'; }
ok "an installed tree may be moved" moved
