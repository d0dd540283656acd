/* Lines such as "at 5 N: carries 9.17 times the load; C4 goes first beyond 9.8". */
#include "cli/print/load_words.h"
#include "eval/structure/holding.h"
#include "graph/framework/frame.h"

#include <math.h>

static void put_one(thr_text *text, const thr_frame *frame, const thr_carry *carry)
{
  if (carry->first_bead < 0) {
    thr_text_append(text, "not decided: more than cords can tell, or than the solver's numbers can\n");
    return;
  }
  if (carry->beyond > 0 && !isfinite(carry->carried)) {
    thr_text_printf(text, "%10s  ", "none found");
    thr_text_printf(text, isfinite(carry->beyond) ? "%10.4g  " : "      none  ", carry->beyond);
  } else if (carry->beyond > 0)
    thr_text_printf(text, isfinite(carry->beyond) ? "%10.4g  %10.4g  " : "%10.4g        none  ", carry->carried, carry->beyond);
  else
    thr_text_append(text, "it does not stand as it is  ");
  thr_text_append_clean(text, frame->name[carry->first_bead]);
  thr_text_append(text, "\n");
}

/* The pull that carries all of it. */
static void put_needed(thr_text *text, const thr_holding *loaded)
{
  thr_text_append(text, "\nload           ");
  if (isfinite(loaded->upper))
    thr_text_printf(text, "all of it is carried with %.4g N at all ends; less than %.4g N is too little (proved)\n",
                    loaded->upper, loaded->lower);
  else if (!isfinite(loaded->lower))
    thr_text_append(text, "no pull carries all of it: something gives way however hard the cords are pulled (proved)\n");
  else
    thr_text_append(text, "whether any pull carries all of it is not decided\n");
}

void load_put(thr_text *text, const thr_frame *frame, const thr_eval *eval)
{
  put_needed(text, &eval->loaded);
  thr_text_append(text, "with equal pulls at all ends, while the cords are drawn in, so many times the load:\n"
                        "  pull (N)     carried    too much  moves first\n");
  for (int i = 0; i < eval->n_carries; i++) {
    thr_text_printf(text, "%10.4g  ", eval->carries[i].pull);
    put_one(text, frame, &eval->carries[i].carry);
  }
  if (!eval->after.present && !eval->stretch.present) return;
  thr_text_append(text, " afterwards ");
  put_one(text, frame, &eval->after_carries);
}

static void put_members(thr_writer *writer, const thr_frame *frame, const thr_carry *carry)
{
  const bool decided = carry->first_bead >= 0;
  thr_write_number(writer, "carried", decided ? carry->carried : NAN);
  thr_write_number(writer, "too_much", decided ? carry->beyond : NAN);
  if (decided)
    thr_write_string(writer, "first_bead", frame->name[carry->first_bead]);
  else
    thr_write_null(writer, "first_bead");
}

void load_put_json(thr_writer *writer, const thr_frame *frame, const thr_eval *eval)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, "load");
  thr_write_number(writer, "needs", eval->loaded.upper);
  thr_write_number(writer, "needs_at_least", eval->loaded.lower);
  thr_write_array(writer, "pulls");
  for (int i = 0; i < eval->n_carries; i++) {
    thr_write_object(writer, NULL);
    thr_write_number(writer, "pull", eval->carries[i].pull);
    put_members(writer, frame, &eval->carries[i].carry);
    thr_write_close(writer);
  }
  thr_write_close(writer);
  if (eval->after.present || eval->stretch.present) {
    thr_write_object(writer, "after");
    put_members(writer, frame, &eval->after_carries);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}
