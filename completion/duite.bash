# Completion of duite's programs in bash. Options and their words are those that --help of the program on the command line has, keys
# those of duite-cloth --keys, scenes those of duite-cloth --scenes: nothing is listed here twice. Answers are kept for the session.

declare -gA _duite_answers # loaded from within a function by bash-completion

# PROGRAM OPTION: what the program prints for the option, into REPLY. MPI needs no network for that.
_duite_ask() {
    local key="$*"
    if [[ -z ${_duite_answers[$key]+known} ]]; then
        _duite_answers[$key]=$(OMPI_MCA_pml=ob1 OMPI_MCA_ess_singleton_isolated=1 "$@" 2> /dev/null < /dev/null)
    fi
    REPLY=${_duite_answers[$key]}
}

# Options from the text of --help: a line each of --OPTION, what it takes, and its description.
_duite_options() {
    awk '
        function say() { if (option) print option "\t" takes "\t" text; option = "" }
        { match($0, /[^ ]/); column = RSTART }
        column > 2 && column <= 7 && /^ *-/ && match($0, /--[a-z0-9-]+/) {
            say()
            option = substr($0, RSTART, RLENGTH); text = substr($0, RSTART + RLENGTH); takes = ""
            if (text ~ /^=/) { takes = substr(text, 2); sub(/ .*/, "", takes) }
            sub(/^[^ ]* */, "", text); next }
        option && column > 20 { text = text (text ? " " : "") substr($0, column); next }
        { say() }
        END { say() }'
}

# The words that a description lists: "...: this, that or those".
_duite_words() {
    sed -n 's/^[^:]*: \(\([A-Za-z_]*, \)*[A-Za-z_]* or [A-Za-z_]*\).*/\1/p' | sed 's/, / /g; s/ or / /'
}

# PROGRAM OPTION: candidates for the option's argument, into COMPREPLY.
_duite_argument() {
    local program=$1 option=$2 line takes text words
    _duite_ask "$program" --help
    line=$(_duite_options <<< "$REPLY" | grep -m 1 -e "^$option	")
    IFS=$'\t' read -r _ takes text <<< "$line"
    case $takes in
        FILE | OUT) mapfile -t COMPREPLY < <(compgen -f -- "$cur") && compopt -o filenames 2> /dev/null ;;
        DIR) mapfile -t COMPREPLY < <(compgen -d -- "$cur") && compopt -o filenames 2> /dev/null ;;
        KEY=VALUE)
            _duite_ask "$program" --keys
            words=$(sed -n 's/^\([a-z][^: ]*\): .*/\1/p' <<< "$REPLY" | sed 's/\[\]/[0]/g; s/$/=/')
            mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur") && compopt -o nospace 2> /dev/null ;;
        *)
            words=$(_duite_words <<< "$text")
            if [[ -z $words && $text == 'as of duite-cloth'* ]]; then
                _duite_ask "${program%duite-*}duite-cloth" --help
                words=$(_duite_options <<< "$REPLY" | grep -m 1 -e "^$option	" | cut -f 3 | _duite_words)
            fi
            mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
            [[ $takes != *=VALUE && $takes != *=METRES ]] || mapfile -t COMPREPLY < <(compgen -S = -W "$words" -- "$cur") ;;
    esac
}

# PROGRAM: candidates for what is no option.
_duite_operand() {
    local names
    case ${1##*/} in
        duite-cloth)
            _duite_ask "$1" --scenes
            names=$(sed -n 's/^\([^ ]*\.yaml\) .*/\1/p' <<< "$REPLY")
            mapfile -t COMPREPLY < <({ compgen -W "$names" -- "$cur"; compgen -f -X '!*.yaml' -- "$cur"; compgen -d -- "$cur"; } | sort -u) ;;
        duite-view) mapfile -t COMPREPLY < <(compgen -d -- "$cur") ;;
        duite-mannequin) COMPREPLY=() ;;
        *) mapfile -t COMPREPLY < <(compgen -f -- "$cur") ;;
    esac
    compopt -o filenames 2> /dev/null
}

_duite() {
    local program=${COMP_WORDS[0]} cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} option=
    program=${program/#\~/$HOME}
    COMPREPLY=()
    # bash takes --option=value apart at the equals sign, which is a word by itself.
    if [[ $cur == = ]]; then
        option=$before cur=
    elif [[ $before == = ]]; then
        option=${COMP_WORDS[COMP_CWORD - 2]}
    elif [[ $before == --* ]]; then
        _duite_ask "$program" --help
        ! _duite_options <<< "$REPLY" | grep -q -e "^$before	[^	]" || option=$before
    fi
    if [[ $option == --* ]]; then
        _duite_argument "$program" "$option"
    elif [[ $cur == -* ]]; then
        _duite_ask "$program" --help
        mapfile -t COMPREPLY < <(compgen -W "$(_duite_options <<< "$REPLY" | awk -F '\t' '{ print $1 ($2 ? "=" : "") }')" -- "$cur")
        [[ ${COMPREPLY[0]-} != *= ]] || compopt -o nospace 2> /dev/null
    else
        _duite_operand "$program"
    fi
}

complete -F _duite duite-cloth duite-compare duite-garment duite-graph duite-mannequin duite-predict duite-trace duite-view
