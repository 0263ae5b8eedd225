# Makes the library's man pages from its headers: awk -v out=FOLDER -f man.awk duite.h duite_policy.h
#
# A paragraph of a header is a comment and the declarations up to the next blank line; each function, macro and type of it has a page with
# that comment. A comment alone belongs to the page before it, the text of a section (---- NAME ----) to each page of the section. At the
# end of a comment stand "Returns:" and "Errors:". A function that returns something and has neither is an error, and so is one that does
# not say whether it is collective or local. Members of structures have their comment above them or behind them.

# ---- From text to roff ----

function quoted(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    gsub(/"/, "\\(dq", text)
    return text
}

function marked(text) { # names of the library in bold, `arguments` in italics
    text = quoted(text)
    gsub(/(duite|DUITE)_[A-Za-z0-9_]*[A-Za-z0-9]/, "\\fB&\\fP", text)
    while (match(text, /`[^`]*`/))
        text = substr(text, 1, RSTART - 1) "\\fI" substr(text, RSTART + 1, RLENGTH - 2) "\\fP" substr(text, RSTART + RLENGTH)
    return text
}

function filled(text,    n, line, i, said, table) { # lines that are indented by four stand as they are
    n = split(text, line, "\n")
    for (i = 1; i <= n; i++) {
        if ((line[i] ~ /^    /) != table) {
            table = !table
            said = said (table ? ".nf\n" : ".fi\n")
        }
        said = said (line[i] == "" ? ".PP\n" : "\\&" marked(line[i]) "\n")
    }
    return said (table ? ".fi\n" : "")
}

function section(title, text) {
    return text == "" ? "" : ".SH " title "\n" text
}

# ---- From C to text ----

function bare(comment) { # without its marks
    sub(/[ \n]*\*\/ *$/, "", comment)
    gsub(/\n *\* ?/, "\n", comment)
    sub(/^ *\/\* ?/, "", comment)
    return comment
}

function cut(text, label) { # returns what stands before the label; what stands after it goes to `after`
    after = ""
    if (!match(text, "(^|[ \n])" label ":[ \n]")) return text
    after = substr(text, RSTART + RLENGTH)
    return substr(text, 1, RSTART - 1)
}

function summary(text) { # the first sentence, for a line of names
    sub(/\n\n.*/, "", text)
    gsub(/\n/, " ", text)
    gsub(/ \([^)]*\)|`/, "", text)
    if (match(text, /[.:;] /)) text = substr(text, 1, RSTART - 1)
    sub(/\.$/, "", text)
    return text ~ /^[A-Z][a-z]* / ? tolower(substr(text, 1, 1)) substr(text, 2) : text
}

function members(body, last,    item, said, note, at) { # each ends with one of the characters `last`
    while (body ~ /[^ \n]/) {
        sub(/^[ \n]+/, "", body)
        if (body ~ /^\/\*/) { # above the next member
            at = index(body, "*/")
            note = bare(substr(body, 1, at + 1))
            body = substr(body, at + 2)
            continue
        }
        item = match(body, "[" last "]|/\\*") ? substr(body, 1, RSTART - 1) : body
        body = substr(body, length(item) + 1)
        sub("^[" last "]", "", body)
        if (body ~ /^ *\/\*/) { # behind this one
            at = index(body, "*/")
            note = bare(substr(body, 1, at + 1))
            body = substr(body, at + 2)
        }
        gsub(/[ \n]+/, " ", item)
        sub(/ $/, "", item)
        gsub(/\n +/, "\n", note)
        said = said ".TP\n.B " quoted(item) "\n" (note == "" ? "\\&\n" : filled(note))
        note = ""
    }
    return said
}

function codes(body,    list, n, i, words) { # what they mean
    gsub(/[ \n]+/, " ", body)
    n = split(body, list, /\*\/ ?/)
    for (i = 1; i <= n; i++)
        if (match(list[i], /DUITE_E_[A-Z_]+/)) {
            words = substr(list[i], index(list[i], "/* ") + 3)
            sub(/ $/, "", words)
            meaning[substr(list[i], RSTART, RLENGTH)] = words
        }
}

# ---- Pages ----

function errors(text,    said, code, rest) { # the sentence, then its codes
    said = filled(text)
    for (rest = text; match(rest, /DUITE_E_[A-Z_]+/); rest = substr(rest, RSTART + RLENGTH)) {
        code = substr(rest, RSTART, RLENGTH)
        if (!index(said, ".B " code "\n")) said = said ".TP\n.B " code "\n" filled(meaning[code])
    }
    return said ".PP\nFurther ones, of any call:\n.BR duite_code (3).\n"
}

function refuse(list, lack) {
    print "man.awk: the comment of " list " says " lack > "/dev/stderr"
    failed = 1
}

function finish(    i, text, gives, fails, list, page) { # the pages of a paragraph, once its notes are there
    fails = cut(about, "Errors") == about ? "" : after
    text = cut(cut(about, "Errors"), "Returns")
    gives = after
    for (i = 1; i <= n_names; i++) list = list (i > 1 ? ", " : "") name[i]
    if (returns && gives == "" && fails == "") refuse(list, "neither what it returns nor its errors")
    if (called && about !~ /[Cc]ollective|[Ll]ocal/) refuse(list, "neither that it is collective nor that it is local")
    if (gives == "" && fails != "") gives = "DUITE_OK, or a code: negative ones of the library, positive ones of a body. duite_message has the message."
    if (section_text != "") notes = notes (notes == "" ? "" : "\n\n") section_text
    page = section("NAME", list " \\- " quoted(summary(text)) "\n") section("SYNOPSIS", ".B #include <" header ">\n" synopsis)
    page = page section("DESCRIPTION", filled(text)) section("MEMBERS", members(inside, synopsis ~ /enum/ ? "," : ";")) section("NOTES", notes == "" ? "" : filled(notes))
    page = page section("RETURN VALUE", gives == "" ? "" : filled(gives)) section("ERRORS", fails == "" ? "" : errors(fails))
    for (i = 1; i <= n_names; i++) {
        pages[name[i]] = page
        named[name[i]] = about notes list inside
    }
    n_names = returns = called = 0
    about = notes = synopsis = inside = ""
}

function declare(line,    own) { # a function, macro or type of this paragraph
    if (match(line, /(duite|DUITE)_[A-Za-z0-9_]*\(/)) own = substr(line, RSTART, RLENGTH - 1)
    else if (match(line, /duite_[a-z_]*/)) own = substr(line, RSTART, RLENGTH)
    name[++n_names] = own
    if (line !~ /^(typedef |enum |#)/) called = 1
    if (line !~ /^(void |typedef |enum |#)/) returns = 1
    gsub(/\n +/, " ", line)
    synopsis = synopsis ".HP 8\n.B \"" quoted(line) "\"\n"
    header = FILENAME
    sub(/.*\//, "", header)
}

function declarations(text,    line, m, i, whole) {
    m = split(text, line, "\n")
    for (i = 1; i <= m; i++) {
        whole = line[i]
        if (whole ~ /^(typedef (struct|enum)|enum) duite_[a-z_]+ \{$/) {
            while (line[++i] !~ /^}/) inside = inside line[i] "\n"
            if (whole ~ /^enum/) codes(inside)
            sub(/ \{$/, "", whole)
            declare(whole (whole ~ /^typedef/ ? substr(whole, index(whole, " duite_")) : "") ";")
        } else if (whole ~ /^#define/) {
            while (line[i] ~ /\\$/) i++
            if (whole ~ /^#define [A-Za-z_]*\(/) {
                sub(/\).*/, ")", whole)
                declare(whole)
            }
        } else if (whole ~ /^static inline/) {
            while (line[i] !~ /^}/) i++
            declare(whole ";")
        } else if (whole ~ /(duite|DUITE)_[a-z0-9_]*\(/ || whole ~ /^extern/) {
            while (line[i] !~ /;$/ && i < m) whole = whole "\n" line[++i]
            if (whole ~ /\(/) declare(whole)
        }
    }
}

function paragraph(text,    end, comment) {
    end = index(text, "*/")
    if (text !~ /^\/\*/ || !end) return
    comment = bare(substr(text, 1, end + 1))
    text = substr(text, end + 3)
    if (text !~ /[a-z]/ && comment ~ /^---- /) {
        finish()
        sub(/^---- [^\n]* ----\n*/, "", comment)
        section_text = comment
    } else if (text !~ /[a-z]/)
        notes = notes (notes == "" ? "" : "\n\n") comment
    else {
        finish()
        about = comment
        declarations(text)
    }
}

FNR == 1 { held = "" }
/^#ifdef __cplusplus/ { cplusplus = 1 }
cplusplus { if (/^#(else|endif)/) cplusplus = 0; next }
/^#(if|else|endif|include|define [A-Z_]*$)/ { next }
/\{$/ { open = 1 }
/^}/ { open = 0 }
/^$/ && !open { paragraph(held); held = ""; next }
{ held = held (held == "" ? "" : "\n") $0 }

END {
    finish()
    for (each in pages) {
        file = out "/" each ".3"
        printf ".TH %s 3 \"\" duite \"Library functions\"\n.ad l\n.nh\n%s.SH SEE ALSO\n.BR duite (3)", each, pages[each] > file
        seen = " " each " "
        for (mentioned = named[each]; match(mentioned, /(duite|DUITE)_[A-Za-z0-9_]*[A-Za-z0-9]/); mentioned = substr(mentioned, RSTART + RLENGTH)) {
            other = substr(mentioned, RSTART, RLENGTH)
            if (!(other in pages) || index(seen, " " other " ")) continue
            seen = seen other " "
            printf ",\n.BR %s (3)", other > file
        }
        printf "\n" > file
        close(file)
    }
    exit failed
}
