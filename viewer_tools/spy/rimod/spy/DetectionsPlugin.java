package rimod.spy;

import lcm.spy.SpyPlugin;
import rimod.detections_t;

/** A double click on a channel of rimod.detections_t shows what was found, from above. */
public final class DetectionsPlugin extends ViewPlugin implements SpyPlugin {
  public DetectionsPlugin() {
    super(detections_t.LCM_FINGERPRINT, "detections", DetectionsView::new);
  }
}
