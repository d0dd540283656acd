/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of a request: every member of `options` in plan.json, with its kind, its range and its
 * place in thr_request.
 *
 * From this one table, with one loop each, plan.json is written and read (docs/plan-format.md), and
 * `thread plan` takes and explains its options that are numbers or words. A new wish that is a
 * number or a word is a member of thr_request (graph/plan/request.h) and a row here; what it does
 * is the planner's, and what it means is the checker's (CONTRIBUTING.md, "a wish").
 *
 *   {"cover", .kind = THR_ASKS_COUNT, AT(cover), .low = 1, .high = 100, .always = true}
 *
 * writes and reads "cover": 2, and makes `--cover 0` a usage error. */
#include "graph/plan/plan_fields.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- members with a shape of their own ---- */

/* Writes which kind of plan was asked for. */
static void write_objective(thr_writer *writer, const thr_plan *plan)
{
  thr_write_string(writer, "objective", thr_objective_name(thr_aims_objective(&plan->options)));
}

/* Reads which kind of plan was asked for. The order of its aims follows from `turning` or
 * `symmetry`. */
static thr_status read_objective(thr_request_reader *reader, const thr_json *object)
{
  int objective;
  thr_status st = thr_field_name(reader->fields, object, "options", "objective", THR_N_OBJECTIVES,
                                 thr_objective_name, &objective);
  if (!st) {
    reader->request->aims = thr_aims_of((thr_objective)objective);
  }
  return st;
}

/* Writes the number of cords: a number if it is exact, else an object with least and most. */
static void write_cords(thr_writer *writer, const thr_plan *plan)
{
  const thr_request *request = &plan->options;

  if (request->cords_least == request->cords) {
    thr_write_int(writer, "cords", request->cords);
    return;
  }

  /* A range. */
  thr_write_object(writer, "cords");
  thr_write_int(writer, "least", request->cords_least);
  thr_write_int(writer, "most", request->cords);
  thr_write_close(writer);
}

/* Reads the number of cords, in either shape. */
static thr_status read_cords(thr_request_reader *reader, const thr_json *object)
{
  static const char *const known[] = {"least", "most", NULL};
  const thr_json *value = thr_json_get(object, "cords");

  /* A number: exactly so many. */
  if (!value || thr_json_typeof(value) != THR_JSON_OBJECT) {
    thr_status st =
        thr_field_int(reader->fields, object, "cords", 1, THR_MOST_CORDS, &reader->request->cords);
    reader->request->cords_least = reader->request->cords;
    return st;
  }

  /* An object: a range, whose least number is at most the largest one. */
  thr_status st = thr_field_only(reader->fields, value, "options.cords", known);
  if (!st)
    st = thr_field_int(reader->fields, value, "most", 1, THR_MOST_CORDS, &reader->request->cords);
  if (!st)
    st = thr_field_int(reader->fields, value, "least", 1, reader->request->cords,
                       &reader->request->cords_least);

  return st;
}

/* Writes whether the longest cord is to be short, if so. */
static void write_balance(thr_writer *writer, const thr_plan *plan)
{
  if (thr_wants_balance(&plan->options)) {
    thr_write_bool(writer, "balance", true);
  }
}

/* Reads a member that is true or false; left out, it is false. */
static thr_status read_yes(const thr_field_reader *reader, const thr_json *object, const char *key,
                           const char *place, bool *yes)
{
  const thr_json *value = thr_json_get(object, key);
  *yes = value && thr_json_true(value);
  return value && thr_json_typeof(value) != THR_JSON_BOOL
             ? thr_field_bad(reader, place, "not true or false")
             : THR_OK;
}

/* Writes where cord ends may be, or how many there are at each node. */
static void write_ends(thr_writer *writer, const thr_plan *plan)
{
  const thr_request *request = &plan->options;
  thr_write_string(writer, "ends", thr_ends_name(request->ends));

  /* The nodes where ends may be. */
  if (request->ends == THR_ENDS_NODES) {
    thr_write_row(writer, "end_nodes");
    for (int v = 0; v < plan->frame.n_nodes; v++) {
      if (request->end_node[v]) {
        thr_write_int(writer, NULL, v);
      }
    }
    thr_write_close(writer);
  }

  /* Pairs of a node and its number of ends. */
  if (request->ends == THR_ENDS_COUNTS) {
    thr_write_row(writer, "end_counts");
    for (int v = 0; v < plan->frame.n_nodes; v++) {
      if (request->end_count[v]) {
        thr_write_ints(writer, NULL, (const int[]){v, request->end_count[v]}, 2);
      }
    }
    thr_write_close(writer);
  }
}

/* Reads the nodes where ends may be into a new array [n_nodes], which the request owns. */
static thr_status read_end_nodes(const thr_field_reader *reader, const thr_json *object,
                                 const thr_frame *frame, bool **end_node)
{
  const thr_json *list;
  thr_status st = thr_field_need(reader, object, "end_nodes", THR_JSON_ARRAY, &list);
  if (st) return st;

  /* Nodes may come in any order. */
  if (!(*end_node = thr_calloc((size_t)frame->n_nodes, sizeof **end_node)))
    return thr_nomem(reader->err);

  for (int i = 0, node = 0; i < thr_json_size(list); i++) {
    if ((st = thr_field_index(reader, list, i, frame->n_nodes, "options.end_nodes", &node)))
      return st;
    (*end_node)[node] = true;
  }

  return THR_OK;
}

/* Reads pairs of a node and the number of cord ends there into a new array [n_nodes], which the
 * request owns. */
static thr_status read_end_counts(const thr_field_reader *reader, const thr_json *object,
                                  const thr_frame *frame, int **end_count)
{
  const thr_json *list;
  thr_status st = thr_field_need(reader, object, "end_counts", THR_JSON_ARRAY, &list);
  if (st) return st;

  if (!(*end_count = thr_calloc((size_t)frame->n_nodes, sizeof **end_count)))
    return thr_nomem(reader->err);

  /* Every pair names another node and 1 to 2 * THR_MOST_CORDS ends. */
  for (int i = 0; i < thr_json_size(list); i++) {
    const thr_json *pair = thr_json_at(list, i);
    int64_t count;
    int node = 0;

    if (thr_json_size(pair) != 2)
      return thr_field_bad(reader, "options.end_counts", "not pairs of a node and a number");
    if ((st = thr_field_index(reader, pair, 0, frame->n_nodes, "options.end_counts", &node)))
      return st;

    if (!thr_json_int(thr_json_at(pair, 1), &count) || count < 1 || count > 2 * THR_MOST_CORDS ||
        (*end_count)[node] > 0)
      return thr_fail(
          reader->err, reader->code,
          "%s: options.end_counts[%d]: not a number from 1 to %d, or the node comes twice",
          reader->name, i, 2 * THR_MOST_CORDS);

    (*end_count)[node] = (int)count;
  }

  return THR_OK;
}

/* Reads the kind of ends, and the list of nodes that belongs to the kind. */
static thr_status read_ends(thr_request_reader *reader, const thr_json *object)
{
  int kind;
  thr_status st = thr_field_name(reader->fields, object, "options", "ends", THR_ENDS_COUNTS + 1,
                                 thr_ends_name, &kind);
  if (st) return st;
  reader->request->ends = (thr_ends)kind;

  /* Lists of nodes belong to one kind of ends each. */
  if (thr_json_get(object, "end_nodes") && reader->request->ends != THR_ENDS_NODES)
    return thr_field_bad(reader->fields, "options.end_nodes", "only with ends `nodes`");
  if (thr_json_get(object, "end_counts") && reader->request->ends != THR_ENDS_COUNTS)
    return thr_field_bad(reader->fields, "options.end_counts", "only with ends `counts`");
  if (reader->request->ends == THR_ENDS_NODES)
    return read_end_nodes(reader->fields, object, reader->frame, &reader->request->end_node);

  return reader->request->ends == THR_ENDS_COUNTS
             ? read_end_counts(reader->fields, object, reader->frame, &reader->request->end_count)
             : THR_OK;
}

/* Writes which turning is minimized: of all cords, of the cord that turns most, or the pulled one.
 * The numbers are those of thr_minimize_name. */
static void write_minimize(thr_writer *writer, const thr_plan *plan)
{
  const thr_request *request = &plan->options;
  thr_write_string(writer, "minimize",
                   thr_minimize_name(thr_wants_largest(request) + thr_wants_pull(request)));
}

/* Reads which turning is minimized. */
static thr_status read_minimize(thr_request_reader *reader, const thr_json *object)
{
  int aim;
  thr_status st = thr_field_name(reader->fields, object, "options.turning", "minimize",
                                 THR_N_MINIMIZE, thr_minimize_name, &aim);
  if (!st) {
    reader->request->aims = (thr_aims){1, {thr_minimize_aim(aim)}};
  }
  return st;
}

/* Writes the group of a symmetric plan, null for the default choice. */
static void write_group(thr_writer *writer, const thr_plan *plan)
{
  const char *group = plan->options.symmetry.group;
  if (*group) {
    thr_write_string(writer, "group", group);
  } else {
    thr_write_null(writer, "group");
  }
}

/* Reads the group of a symmetric plan. */
static thr_status read_group(thr_request_reader *reader, const thr_json *object)
{
  char *group = reader->request->symmetry.group;
  const thr_json *value = thr_json_get(object, "group");
  const char *name = thr_json_string(value);
  const bool is_null = value && thr_json_typeof(value) == THR_JSON_NULL;

  /* The name has to fit into the request, and the empty name is the default's. */
  if (!is_null && (!name || !*name || strlen(name) >= sizeof reader->request->symmetry.group))
    return thr_field_bad(reader->fields, "options.symmetry.group",
                         "neither null nor a text of 1 to 15 bytes");

  /* Names from a file may hold control characters. */
  snprintf(group, sizeof reader->request->symmetry.group, "%s", name ? name : "");
  thr_text_clean(group);

  return THR_OK;
}

/* Writes whether a number of cords was asked for, if so. */
static void write_counted(thr_writer *writer, const thr_plan *plan)
{
  if (plan->options.symmetry.counted) {
    thr_write_bool(writer, "counted", true);
  }
}

/* Reads whether a number of cords was asked for. */
static thr_status read_counted(thr_request_reader *reader, const thr_json *object)
{
  return read_yes(reader->fields, object, "counted", "options.symmetry.counted",
                  &reader->request->symmetry.counted);
}

/* Writes the aims of a symmetric plan in their order. */
static void write_prefer(thr_writer *writer, const thr_plan *plan)
{
  thr_aim order[THR_N_AIMS];
  thr_aims_order(&plan->options, order);

  /* All four, also those that the request does not name. */
  thr_write_array(writer, "prefer");
  for (int i = 0; i < THR_N_AIMS; i++) {
    thr_write_string(writer, NULL, thr_aim_name(order[i]));
  }
  thr_write_close(writer);
}

/* Reads the order of a symmetric plan's aims, each of which must be named once. */
static thr_status read_prefer(thr_request_reader *reader, const thr_json *object)
{
  bool named[THR_N_AIMS] = {false};
  const thr_json *list;
  thr_status st = thr_field_need(reader->fields, object, "prefer", THR_JSON_ARRAY, &list);

  if (!st && thr_json_size(list) != THR_N_AIMS)
    return thr_field_bad(reader->fields, "options.symmetry.prefer", "not four aims");

  /* With THR_N_AIMS names and none twice, all aims are there. */
  for (int i = 0, aim = 0; i < THR_N_AIMS && !st; i++) {
    st = thr_field_name_of(reader->fields, thr_json_at(list, i), "options.symmetry", "prefer",
                           THR_N_AIMS, thr_aim_name, &aim);
    if (!st && named[aim])
      return thr_field_bad(reader->fields, "options.symmetry.prefer", "names one aim twice");
    named[aim] = true;
    reader->request->aims.aim[i] = (thr_aim)aim;
  }

  reader->request->aims.n = THR_N_AIMS;

  return st;
}

/* Writes the quantities of cord and bead. */
static void write_physics(thr_writer *writer, const thr_plan *plan)
{
  thr_write_line(writer, 2);
  thr_physics_write(&plan->options.physics, writer, "physics");
}

/* Reads the quantities of cord and bead. */
static thr_status read_physics(thr_request_reader *reader, const thr_json *object)
{
  char place[256];
  snprintf(place, sizeof place, "%.200s: options.physics", reader->fields->name);
  return thr_physics_from_json(&reader->request->physics, thr_json_get(object, "physics"), place,
                               reader->fields->err);
}

/* Objects of members that only one objective has. The functions follow the table, since their
 * members are rows of the table, too. */
static void write_turning(thr_writer *writer, const thr_plan *plan);
static void write_symmetry(thr_writer *writer, const thr_plan *plan);
static thr_status read_turning(thr_request_reader *reader, const thr_json *object);
static thr_status read_symmetry(thr_request_reader *reader, const thr_json *object);

/* ---- the table ---- */

#define AT(member) .offset = offsetof(thr_request, member)
#define COUNT .kind = THR_ASKS_COUNT
#define AMOUNT .kind = THR_ASKS_AMOUNT
#define AMOUNT_OR_NULL .kind = THR_ASKS_AMOUNT_OR_NULL
#define WORD(names, n) .kind = THR_ASKS_WORD, .name = (names), .n_names = (n)
#define OTHER(what) .kind = THR_ASKS_OTHER, .write = write_##what, .read = read_##what
#define TINY 5e-324 /* the least number above 0 */

/* The rows, in the order of the members in plan.json. */
const thr_request_field thr_request_fields[] = {
    {"objective", .kind = THR_ASKS_OTHER,
     .write = write_objective}, /* read first: thr_plan_read_options */
    {"joint", WORD(thr_joint_name, 2), AT(joint), .always = true,
     .help = "solid: node beads are rigid pieces (default); tube: the cord ties the edges "
             "together at every node"},
    {"cover", COUNT, AT(cover), .low = 1, .high = 100, .always = true, .value = "N",
     .help = "at least N passes of cord over every interface (default: 1)"},
    {"capacity", COUNT, AT(capacity), .low = 1, .high = INT32_MAX, .value = "N",
     .help = "at most N passes over every interface; --bore and --cord-diameter together: as "
             "many as fit"},
    {"distinct", COUNT, AT(distinct), .low = 2, .high = 100, .value = "N",
     .help = "at least N different cords over every interface: two hold planar faces, three "
             "any (thesis); --cover and --cords are N if not given"},
    {"cords", OTHER(cords), .always = true},
    {"max_length", .option = "max-length", AMOUNT, AT(max_length), .low = TINY, .high = INFINITY,
     .value = "L", .help = "as few cords as it takes for none to be longer than L units"},
    {"max_pull", AMOUNT, AT(max_pull), .low = 1, .high = INFINITY},
    {"balance", .kind = THR_ASKS_OTHER,
     .write = write_balance}, /* read last: thr_plan_read_options */
    {"ends", OTHER(ends), .always = true},
    {"end_nodes", .kind = THR_ASKS_OTHER},  /* with ends */
    {"end_counts", .kind = THR_ASKS_OTHER}, /* with ends */
    {"turning", OTHER(turning)},
    {"cost", .option = "turn-cost", .in = "turning", WORD(thr_turn_cost_name, THR_N_TURN_COSTS),
     AT(turning.cost), .always = true,
     .help = "price of a turn: its angle (default), the sine of half of it, 1 from 90 "
             "degrees on, or 1 for a U-turn"},
    {"length_slack", .in = "turning", AMOUNT_OR_NULL, AT(turning.length_slack), .high = INFINITY,
     .always = true},
    {"minimize", .in = "turning", OTHER(minimize), .always = true},
    {"tour", .in = "turning", WORD(thr_tour_name, THR_N_TOURS), AT(turning.tour), .always = true,
     .help = "the least turning (default), or a classical tour through the shortest passes"},
    {"pairings", .in = "turning", WORD(thr_pairings_name, 2), AT(turning.pairings), .always = true,
     .help = "of a classical tour: keep to the cheapest pairing at every node, or not "
             "(default: keep)"},
    {"nodes", .in = "turning", COUNT, AT(turning.nodes), .low = 1, .high = INT32_MAX, .value = "N",
     .tuned = true, .help = "the search ends when its tree has N nodes, wherever it runs"},
    {"symmetry", OTHER(symmetry)},
    {"group", .in = "symmetry", OTHER(group), .always = true},
    {"geometric", .in = "symmetry", AMOUNT_OR_NULL, AT(symmetry.geometric), .high = INFINITY,
     .always = true},
    {"counted", .in = "symmetry", OTHER(counted)},
    {"prefer", .in = "symmetry", OTHER(prefer), .always = true},
    {"order", WORD(thr_order_name, THR_N_ORDERS), AT(order),
     .help = "the order of work: as it was planned, or begun and led so that what is threaded so "
             "far holds together, for at most a twentieth more turning (starts, the default), or "
             "a tenth (hand)"},
    {"crossings", WORD(thr_crossings_name, THR_N_CROSSINGS), AT(crossings),
     .help = "channels that cross inside a piece: allow any (default); price: fewer, where "
             "that takes no more cord, or with an aim of turning no more turning; forbid: none, "
             "however much more the cords turn. To that end cords that cross exchange their ends, "
             "and closed ones are joined and cut elsewhere, if what is asked of single cords "
             "allows it. Not with tube joints or symmetric plans"},
    {"needles", COUNT, AT(needles), .low = 1, .high = 2},
    {"engine", WORD(thr_engine_name, 3), AT(engine), .tuned = true,
     .help = "what finds the shortest passes"},
    {"confirm", WORD(thr_confirm_name, 3), AT(confirm), .tuned = true,
     .help = "does GLPK find the same length, exactly?"},
    {"time_limit", AMOUNT, AT(time_limit), .high = INFINITY, .always = true},
    {"gap", AMOUNT, AT(gap), .high = 100, .value = "PERCENT",
     .help = "end the search at a plan that is proved to be at most so much above the least "
             "possible, 0 = the least itself (default: 0 for length, else 1)"},
    {"physics", OTHER(physics), .always = true},
};
const int thr_request_n_fields = (int)(sizeof thr_request_fields / sizeof *thr_request_fields);

/* Returns the request that a plan without any options stands for: the defaults, except that the
 * order of work is as planned, since older plans had no other. */
static thr_request unsaid(void)
{
  thr_request request = thr_request_default();
  request.order = THR_ORDER_PLANNED;
  return request;
}

/* ---- writing ---- */

/* Returns whether two names of objects in `options` are equal; NULL is `options` itself. */
static bool same_place(const char *a, const char *b)
{
  return a == b || (a && b && strcmp(a, b) == 0);
}

/* Returns the row of plan.json that a row of the request is, if the row has no functions of its
 * own. */
static thr_field field_of(const thr_request_field *row)
{
  thr_field field = {row->key, (thr_field_kind)row->kind, .offset = row->offset, .name = row->name};
  field.n_names = row->n_names;

  /* Ranges of amounts are checked after they are read. */
  if (row->kind == THR_ASKS_COUNT) {
    field.low = (int64_t)row->low;
    field.high = (int64_t)row->high;
  }
  return field;
}

/* Writes the rows of `options` (in = NULL), or of one of its objects. */
static void write_rows(thr_writer *writer, const thr_plan *plan, const char *in)
{
  thr_request request = plan->options, usual = unsaid();

  /* Whether GLPK was asked for the same length says nothing of other plans. */
  if (!thr_wants_length(&request)) {
    request.confirm = usual.confirm;
  }

  /* Rows with functions of their own decide themselves what is left out. */
  for (int i = 0; i < thr_request_n_fields; i++) {
    const thr_request_field *field = &thr_request_fields[i];
    if (!same_place(field->in, in)) continue;
    const thr_field row[] = {field_of(field), {0}};
    if (field->write) {
      field->write(writer, plan);
    } else if (field->always || thr_field_number(row, &request) != thr_field_number(row, &usual)) {
      thr_fields_write(writer, row, &request);
    }
  }
}

/* Writes an object in `options` with all of its rows. */
static void write_member(thr_writer *writer, const thr_plan *plan, const char *key)
{
  thr_write_object(writer, key);
  write_rows(writer, plan, key);
  thr_write_close(writer);
  thr_write_line(writer, 2);
}

/* Writes what only plans of little turning have. */
static void write_turning(thr_writer *writer, const thr_plan *plan)
{
  if (thr_wants_turning(&plan->options)) {
    write_member(writer, plan, "turning");
  }
}

/* Writes what only symmetric plans have. */
static void write_symmetry(thr_writer *writer, const thr_plan *plan)
{
  if (thr_wants_symmetry(&plan->options)) {
    write_member(writer, plan, "symmetry");
  }
}

void thr_request_write(thr_writer *writer, const thr_plan *plan)
{
  thr_write_object(writer, "options");
  write_rows(writer, plan, NULL);
  thr_write_close(writer);
}

/* ---- reading ---- */

/* Reads a number or a word within the range of its row. place: of the object, for messages. */
static thr_status read_value(thr_request_reader *reader, const thr_json *object, const char *place,
                             const thr_request_field *field)
{
  const thr_field row = field_of(field);
  const bool is_integer = field->kind == THR_ASKS_COUNT || field->kind == THR_ASKS_WORD;
  char member[80];

  /* Amounts are compared with the range here. A null, which is read as -1, is in any range. */
  const thr_status st = thr_field_read(reader->fields, object, place, &row, reader->request);
  const double amount = thr_field_number(&row, reader->request);
  const bool is_null = field->kind == THR_ASKS_AMOUNT_OR_NULL && amount < 0;
  if (st || is_integer || is_null || (amount >= field->low && amount <= field->high)) return st;

  snprintf(member, sizeof member, "%s.%s", place, field->key);

  return thr_field_bad(reader->fields, member,
                       amount > field->high ? "too large"
                       : amount == 0        ? "not above 0"
                                            : "too small");
}

/* Reads the rows of `options` (in = NULL), or of one of its objects. Refuses a member that the
 * table does not know, or that belongs to another objective: such a member may be a wish that
 * nobody checks. */
static thr_status read_rows(thr_request_reader *reader, const thr_json *object, const char *in)
{
  const thr_objective objective = thr_aims_objective(reader->request);
  const char *known[sizeof thr_request_fields / sizeof *thr_request_fields + 1], *place = "options";
  char member[40];
  int n = 0;

  /* The name of the object, for messages. */
  if (in) {
    snprintf(member, sizeof member, "options.%s", in);
    place = member;
  }

  /* Which members there may be. */
  for (int i = 0; i < thr_request_n_fields; i++) {
    const thr_request_field *field = &thr_request_fields[i];
    const bool is_foreign = (field->read == read_turning && objective != THR_TORTUOSITY) ||
                            (field->read == read_symmetry && objective != THR_SYMMETRY) ||
                            (field->name == thr_confirm_name && objective != THR_LENGTH);
    if (same_place(field->in, in) && !is_foreign) {
      known[n++] = field->key;
    }
  }

  /* Members of `options` that are no row of this objective are refused. */
  known[n] = NULL;
  thr_status st = thr_field_only(reader->fields, object, place, known);

  /* A row that is left out keeps its default, unless the format demands it. */
  for (int i = 0; i < thr_request_n_fields && !st; i++) {
    const thr_request_field *field = &thr_request_fields[i];
    if (!same_place(field->in, in) || (!field->always && !thr_json_get(object, field->key)))
      continue;
    if (field->kind != THR_ASKS_OTHER) {
      st = read_value(reader, object, place, field);
    } else if (field->read) {
      st = field->read(reader, object);
    }
  }

  return st;
}

/* Reads an object in `options` with all of its rows. */
static thr_status read_member(thr_request_reader *reader, const thr_json *object, const char *key)
{
  const thr_json *value;
  const thr_status st = thr_field_need(reader->fields, object, key, THR_JSON_OBJECT, &value);
  return st ? st : read_rows(reader, value, key);
}

/* Reads what only plans of little turning have. */
static thr_status read_turning(thr_request_reader *reader, const thr_json *object)
{
  return read_member(reader, object, "turning");
}

/* Reads what only symmetric plans have. */
static thr_status read_symmetry(thr_request_reader *reader, const thr_json *object)
{
  return read_member(reader, object, "symmetry");
}

/* Refuses wishes that do not go together. */
static thr_status check_together(const thr_field_reader *reader, const thr_request *request)
{
  /* k different cords over every edge take k passes and k cords; a classical tour makes one. */
  if (request->distinct > request->cover)
    return thr_field_bad(reader, "options.distinct", "more than cover");
  if (request->distinct > (thr_plan_counted(request) ? request->cords_least : request->cords))
    return thr_field_bad(reader, "options.distinct", "more than the cords");
  if (request->distinct > 0 && thr_wants_turning(request) &&
      request->turning.tour != THR_TOUR_LEAST)
    return thr_field_bad(reader, "options.distinct", "not with a classical tour");

  /* Only cords in solid pieces have channels that can cross. */
  if (request->crossings != THR_CROSSINGS_ALLOW && request->joint == THR_JOINT_TUBE)
    return thr_field_bad(reader, "options.crossings", "goes with solid joints");

  /* The capstan law needs the angles of the turns. */
  if (thr_wants_pull(request) && request->turning.cost != THR_TURN_ANGLE)
    return thr_field_bad(reader, "options.turning.cost", "a pull is of angles");

  return THR_OK;
}

thr_status thr_plan_read_options(const thr_field_reader *reader, const thr_json *doc,
                                 const thr_frame *frame, thr_request *request)
{
  const thr_json *object;
  bool balance = false;
  thr_status st = thr_field_need(reader, doc, "options", THR_JSON_OBJECT, &object);
  if (st) return st;

  *request = unsaid();

  /* The objective comes first: it says which objects must be there. */
  thr_request_reader request_reader = {reader, frame, request};
  st = read_objective(&request_reader, object);
  const char *own = thr_wants_turning(request) ? "turning" : "symmetry";
  const bool has_own = !thr_wants_length(request);
  const thr_json *member;
  if (!st) st = read_rows(&request_reader, object, NULL);
  if (!st && has_own) st = thr_field_need(reader, object, own, THR_JSON_OBJECT, &member);

  /* A short longest cord comes before all other aims. */
  if (!st) st = read_yes(reader, object, "balance", "options.balance", &balance);
  if (!st && balance) {
    memmove(&request->aims.aim[1], request->aims.aim,
            (size_t)request->aims.n++ * sizeof *request->aims.aim);
    request->aims.aim[0] = THR_AIM_LONGEST;
  }

  return st ? st : check_together(reader, request);
}
