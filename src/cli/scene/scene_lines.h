/* scene_lines.h: in which line of a JSON text a key stands; jansson tells lines of syntax errors alone. */
#ifndef TC_CLI_SCENE_LINES_H
#define TC_CLI_SCENE_LINES_H

/* The line, from 1, of `key` in the object under `section` of the outermost object ("": in that itself). Where the key
 * is not found that of the section, else 1. A section that is a list of objects is "section[2]". text must be valid JSON. Cost: one pass. */
int tc_json_line(const char *text, const char *section, const char *key);

#endif
