package rimod.spy;

import lcm.spy.SpyPlugin;
import rimod.status_t;

/** A double click on a channel of rimod.status_t shows what the processes do. */
public final class StatusPlugin extends ViewPlugin implements SpyPlugin {
  public StatusPlugin() {
    super(status_t.LCM_FINGERPRINT, "status", StatusView::new);
  }
}
