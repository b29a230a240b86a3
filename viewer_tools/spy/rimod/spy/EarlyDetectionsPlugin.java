package rimod.spy;

import lcm.spy.SpyPlugin;
import rimod.early_detections_t;

/** A double click on a channel of rimod.early_detections_t shows what is told so far, from above. */
public final class EarlyDetectionsPlugin extends ViewPlugin implements SpyPlugin {
  public EarlyDetectionsPlugin() {
    super(early_detections_t.LCM_FINGERPRINT, "early detections", DetectionsView::new);
  }
}
